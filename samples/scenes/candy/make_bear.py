#!/usr/bin/env python3
"""Writes bear.obj, a sitting bear about 16 centimetres tall, one closed surface. It sits on y = 0 and looks along +z.

    python3 make_bear.py [bear.obj]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402
from mesh_tools import ball, capsule, ellipsoid  # noqa: E402

CELL = 0.004
BLEND = 0.010


def bear():
    parts = [
        ellipsoid((0, 0.052, 0), (0.043, 0.054, 0.038)),  # body
        ellipsoid((0, 0.122, 0.004), (0.036, 0.032, 0.032)),  # head
        ellipsoid((0, 0.114, 0.033), (0.016, 0.012, 0.014)),  # snout
        ball((0, 0.030, -0.038), 0.011),  # tail
    ]
    for side in (-1, 1):
        parts += [
            ball((side * 0.030, 0.150, 0.0), 0.0135),  # ear
            capsule((side * 0.036, 0.082, 0.008), (side * 0.052, 0.050, 0.034), 0.014),  # arm
            capsule((side * 0.026, 0.019, 0.018), (side * 0.040, 0.017, 0.062), 0.0175),  # leg
            ellipsoid((side * 0.042, 0.022, 0.070), (0.016, 0.021, 0.012)),  # foot
        ]
    return mesh_tools.union(parts, BLEND)


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "bear.obj"
    vertices, triangles = mesh_tools.surface_nets(bear(), (-0.081, -0.011, -0.061), (0.081, 0.179, 0.101), CELL)
    bottom = min(v[1] for v in vertices)
    vertices = [(x, y - bottom, z) for x, y, z in vertices]
    mesh_tools.write_obj(path, "bear", "A sitting bear, written by make_bear.py. It sits on y = 0.", (vertices, triangles), digits=4)


if __name__ == "__main__":
    main()
