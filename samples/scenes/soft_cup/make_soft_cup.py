#!/usr/bin/env python3
"""Writes soft_cup.obj, a cup on y = 0 whose wall has rings enough to be bent.

    python3 make_soft_cup.py [FOLDER]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    foot, rim, height, wall, steps, segments = 0.045, 0.058, 0.12, 0.005, 14, 48
    outer = [(foot + (rim - foot) * k / steps, height * k / steps) for k in range(steps + 1)]
    inner = [(foot + (rim - foot) * k / steps - wall, wall + (height - wall) * k / steps) for k in range(steps, -1, -1)]
    mesh_tools.write_obj(str(folder / "soft_cup.obj"), "soft_cup", "A soft cup, written by make_soft_cup.py.",
                         mesh_tools.revolve(outer + inner, 0.0, wall, segments))


if __name__ == "__main__":
    main()
