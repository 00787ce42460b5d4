#!/usr/bin/env python3
"""Writes imp.obj, with horns and a tail, and hare.obj, with long ears: two plump creatures about 13 centimetres tall, each one closed
surface. Their middles are at the origin.

    python3 make_monsters.py [folder]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402
from mesh_tools import ball, capsule, ellipsoid  # noqa: E402

CELL = 0.005
BLEND = 0.014


def mirrored(make):
    return [make(-1), make(1)]


def imp():
    return [
        ellipsoid((0, -0.012, 0), (0.040, 0.042, 0.034)),
        ellipsoid((0, 0.030, 0.004), (0.034, 0.028, 0.030)),
        *mirrored(lambda s: capsule((s * 0.022, 0.048, 0), (s * 0.040, 0.082, -0.004), 0.0125, 0.0085)),  # horns
        *mirrored(lambda s: capsule((s * 0.036, 0.000, 0.006), (s * 0.066, 0.018, 0.014), 0.0125)),  # arms
        *mirrored(lambda s: capsule((s * 0.021, -0.040, 0.0), (s * 0.025, -0.058, 0.010), 0.0155)),  # feet
        capsule((0, -0.035, -0.028), (0, -0.022, -0.068), 0.012, 0.0095),  # tail
    ]


def hare():
    return [
        ellipsoid((0, -0.016, 0), (0.036, 0.044, 0.036)),
        ball((0, 0.030, 0.006), 0.028),
        *mirrored(lambda s: capsule((s * 0.012, 0.048, 0), (s * 0.022, 0.094, -0.010), 0.0115, 0.0105)),  # ears
        *mirrored(lambda s: capsule((s * 0.030, -0.004, 0.012), (s * 0.044, -0.022, 0.036), 0.0120)),  # paws
        *mirrored(lambda s: capsule((s * 0.022, -0.050, 0.002), (s * 0.028, -0.056, 0.030), 0.0150)),  # feet
        ball((0, -0.038, -0.038), 0.0165),  # tail
    ]


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    for name, parts in (("imp", imp()), ("hare", hare())):
        reach = (0.0901, 0.1201, 0.0901)
        mesh = mesh_tools.surface_nets(mesh_tools.union(parts, BLEND), [-a for a in reach], reach, CELL)
        mesh_tools.write_obj(folder / f"{name}.obj", name, f"A creature, the {name}, written by make_monsters.py.", mesh)


if __name__ == "__main__":
    main()
