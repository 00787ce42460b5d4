#!/usr/bin/env python3
"""Writes wheel.obj, a wheel with six spokes standing on y = 0, its axle along z.

    python3 make_wheel.py [wheel.obj]
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

RADIUS, RIM, HUB, SPOKE = 0.09, 0.021, 0.025, 0.018  # outer radius, the rim's thickness, the hub's radius, a spoke's width
WIDTH = 0.044
SPOKES = 6
BLEND = 0.006
CELL = 0.004


def wheel(x, y, z):
    """Flat: the distance within the wheel's plane, cut to the width; edges are rounded by the grid."""
    radius = math.hypot(x, y)
    shape = max(radius - RADIUS, RADIUS - RIM - radius)
    parts = [radius - HUB]
    for spoke in range(SPOKES):
        turn = 2 * math.pi * (spoke + 0.5) / SPOKES
        along, aside = x * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - x * math.sin(turn)
        parts.append(max(abs(aside) - SPOKE / 2, -along, radius - (RADIUS - RIM / 2)))
    for part in parts:
        share = max(BLEND - abs(shape - part), 0.0) / BLEND
        shape = min(shape, part) - share * share * BLEND / 4
    return max(shape, abs(z) - WIDTH / 2)


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "wheel.obj"
    reach, side = RADIUS + 0.0051, WIDTH / 2 + 0.0051
    vertices, triangles = mesh_tools.surface_nets(wheel, (-reach, -reach, -side), (reach, reach, side), CELL)
    bottom = min(v[1] for v in vertices)
    vertices = [(x, y - bottom, z) for x, y, z in vertices]
    mesh_tools.write_obj(path, "wheel", "A wheel with spokes, written by make_wheel.py. It stands on y = 0.", (vertices, triangles), digits=4)


if __name__ == "__main__":
    main()
