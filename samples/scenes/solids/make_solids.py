#!/usr/bin/env python3
"""Writes gem.obj, which is convex, and ring.obj and bowl.obj, which are not.

    python3 make_solids.py [FOLDER]
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402


def circle(center, radius, count):
    """Clockwise points of (radius, height)."""
    turns = [-2 * math.pi * k / count for k in range(count)]
    return [(center + radius * math.cos(t), radius * math.sin(t)) for t in turns]


def bowl(radius, wall, steps):
    """The profile of half a hollow ball, open at the top, with its axis left out."""
    angles = [-0.5 * math.pi + 0.5 * math.pi * (k + 0.15) / (steps + 0.15) for k in range(steps + 1)]
    inner = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    outer = [((radius + wall) * math.cos(a), (radius + wall) * math.sin(a)) for a in angles]
    rings = outer + list(reversed(inner))
    return rings, -(radius + wall), -radius


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    gem = mesh_tools.revolve([(0.034, -0.002), (0.04, 0.012), (0.024, 0.036)], -0.028, 0.042, 7)
    mesh_tools.write_obj(str(folder / "gem.obj"), "gem", "A convex gem, written by make_solids.py.", gem)
    ring = mesh_tools.lathe(circle(0.036, 0.014, 24), 64)
    mesh_tools.write_obj(str(folder / "ring.obj"), "ring", "A ring about the y axis, written by make_solids.py.", ring)
    rings, bottom, top = bowl(0.045, 0.006, 16)
    mesh_tools.write_obj(str(folder / "bowl.obj"), "bowl", "A bowl, open at the top, written by make_solids.py.",
                         mesh_tools.revolve(rings, bottom, top, 64))


if __name__ == "__main__":
    main()
