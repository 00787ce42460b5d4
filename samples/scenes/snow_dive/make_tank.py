#!/usr/bin/env python3
"""Writes tank.obj: four glass walls that stand on y = 0.

    python3 make_tank.py [tank.obj]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

INNER, WALL, HEIGHT = 0.125, 0.005, 0.15  # half the inner width, the walls' thickness


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "tank.obj"
    mesh_tools.write_obj(path, "tank", "The walls of a tank, written by make_tank.py. They stand on y = 0.",
                         mesh_tools.square_tube(INNER, WALL, 0.0, HEIGHT))


if __name__ == "__main__":
    main()
