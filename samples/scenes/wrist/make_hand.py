#!/usr/bin/env python3
"""Writes hand.obj, a right hand with its forearm, fingers down, whose wrist is at the origin, and vat.obj, the walls of a vat on y = 0.

    python3 make_hand.py [folder]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402
from mesh_tools import capsule, ellipsoid  # noqa: E402

CELL = 0.0038
BLEND = 0.010

INNER, WALL, HEIGHT = 0.145, 0.006, 0.115  # half the vat's inner width, its walls' thickness


def finger(x, lean, length, radius):
    """From a knuckle at x, down, leaning aside, the last joint a little forward."""
    knuckle = (x, -0.088, 0.0)
    middle = (x + 0.5 * lean, -0.088 - 0.55 * length, 0.004)
    tip = (x + lean, -0.088 - length, 0.018)
    return [capsule(knuckle, middle, radius, 0.92 * radius), capsule(middle, tip, 0.92 * radius, 0.78 * radius)]


def hand():
    return [
        capsule((0, 0.150, 0), (0, 0.010, 0), 0.036, 0.025),  # forearm
        ellipsoid((0, -0.050, 0), (0.043, 0.056, 0.019)),  # palm
        *finger(-0.032, -0.022, 0.052, 0.0085),
        *finger(-0.011, -0.006, 0.070, 0.0095),
        *finger(0.011, 0.006, 0.076, 0.0098),
        *finger(0.031, 0.018, 0.068, 0.0092),
        capsule((0.028, -0.030, 0.006), (0.066, -0.062, 0.022), 0.0140, 0.0110),  # thumb
        capsule((0.066, -0.062, 0.022), (0.078, -0.092, 0.028), 0.0110, 0.0092),
    ]


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    low, high = (-0.0801, -0.1901, -0.0451), (0.1001, 0.1951, 0.0501)
    mesh = mesh_tools.surface_nets(mesh_tools.union(hand(), BLEND), low, high, CELL)
    mesh_tools.write_obj(folder / "hand.obj", "hand", "A hand with its forearm, written by make_hand.py. The wrist is at the origin.", mesh)
    mesh_tools.write_obj(folder / "vat.obj", "vat", "The walls of a vat, written by make_hand.py. They stand on y = 0.",
                         mesh_tools.square_tube(INNER, WALL, 0.0, HEIGHT))


if __name__ == "__main__":
    main()
