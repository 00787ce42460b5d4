#!/usr/bin/env python3
"""Writes cup.obj, a cup that widens upwards, and dish.obj, a flat dish. Both stand on y = 0.

    python3 make_cup.py [FOLDER]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402


def vessel(foot, rim, height, wall, segments):
    """`foot` and `rim` are the outer radii."""
    rings = [(foot, 0.0), (rim, height), (rim - wall, height), (foot - wall, wall)]
    return mesh_tools.revolve(rings, 0.0, wall, segments)


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    mesh_tools.write_obj(str(folder / "cup.obj"), "cup", "A cup, written by make_cup.py.", vessel(0.045, 0.06, 0.13, 0.006, 64))
    mesh_tools.write_obj(str(folder / "dish.obj"), "dish", "A dish, written by make_cup.py.", vessel(0.09, 0.13, 0.035, 0.006, 96))


if __name__ == "__main__":
    main()
