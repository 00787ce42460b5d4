#!/usr/bin/env python3
"""Writes block.obj, an upright block with a notch in one of its sides, above its foot.

    python3 make_notched_block.py [block.obj]
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

WIDTH, HEIGHT, DEPTH = 0.14, 0.20, 0.08
NOTCH_LOW, NOTCH_HIGH, NOTCH_DEPTH = 0.05, 0.09, 0.07


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "block.obj"
    right = WIDTH / 2
    tip = (right - NOTCH_DEPTH, (NOTCH_LOW + NOTCH_HIGH) / 2)
    outline = [(-right, 0.0), (right, 0.0), (right, NOTCH_LOW), tip, (right, NOTCH_HIGH), (right, HEIGHT), (-right, HEIGHT)]
    mesh_tools.write_obj(path, "block", "A notched block, written by make_notched_block.py. It stands on y = 0.",
                         mesh_tools.prism(outline, DEPTH, fan=3))


if __name__ == "__main__":
    main()
