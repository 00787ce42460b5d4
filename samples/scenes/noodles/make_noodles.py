#!/usr/bin/env python3
"""Writes mould.obj, a square plate with sixteen round holes, and tube.obj, the square walls that stand on it.

    python3 make_noodles.py [folder]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

INNER = 0.06  # half the tube's inner width
WALL = 0.004
TUBE_HEIGHT = 0.13
TILES = 4
HOLE_RADIUS = 0.009
PLATE_THICKNESS = 0.008


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    plate = mesh_tools.plate_with_holes(TILES, 2 * (INNER + WALL) / TILES, HOLE_RADIUS, PLATE_THICKNESS, 24)
    mesh_tools.write_obj(folder / "mould.obj", "mould", "A plate with holes, written by make_noodles.py. Its upper face is y = 0.", plate)
    tube = mesh_tools.square_tube(INNER, WALL, 0.0, TUBE_HEIGHT)
    mesh_tools.write_obj(folder / "tube.obj", "tube", "The walls over the mould, written by make_noodles.py. They stand on y = 0.", tube)


if __name__ == "__main__":
    main()
