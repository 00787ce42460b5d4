#!/usr/bin/env python3
"""Writes wheel.obj, an overshot wheel: a drum with blades between two rims, on spokes, its axle along z through the origin.

    python3 make_wheel.py [wheel.obj]
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

DRUM, RADIUS, WIDTH = 0.074, 0.125, 0.09  # m
BLADES, BLADE = 10, 0.006                 # their number and thickness
LEAN = 0.30                               # radians by which a blade's edge is ahead of its foot, so that it holds more
WALL, RIM, SEGMENTS = 0.006, 0.006, 80
HUB, SPOKES, SPOKE = 0.016, 5, 0.010


def ring(inner, outer, width, z):
    """About the axle."""
    half = width / 2
    vertices, triangles = mesh_tools.lathe([(inner, -half), (inner, half), (outer, half), (outer, -half)], SEGMENTS)
    # The ring's axis, from y to z.
    return mesh_tools.oriented(([(x, depth, height + z) for x, height, depth in vertices], triangles))


def hub():
    return mesh_tools.prism([(HUB * math.cos(2 * math.pi * k / 24), HUB * math.sin(2 * math.pi * k / 24)) for k in range(24)],
                            WIDTH + 0.02, fan=0)


def bar(a, b, thickness, width):
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    across = (-(b[1] - a[1]) / length * thickness / 2, (b[0] - a[0]) / length * thickness / 2)
    corners = [(a[0] - across[0], a[1] - across[1]), (b[0] - across[0], b[1] - across[1]),
               (b[0] + across[0], b[1] + across[1]), (a[0] + across[0], a[1] + across[1])]
    return mesh_tools.prism(corners, width, fan=0)


def spoke(turn):
    """From inside of the hub into the drum's wall."""
    foot, edge = 0.8 * HUB, DRUM - WALL / 2
    return bar((foot * math.cos(turn), foot * math.sin(turn)), (edge * math.cos(turn), edge * math.sin(turn)), SPOKE, WIDTH - 0.01)


def blade(turn):
    """From inside of the drum's wall to the edge."""
    foot, edge = DRUM - WALL / 2, RADIUS
    return bar((foot * math.cos(turn), foot * math.sin(turn)), (edge * math.cos(turn + LEAN), edge * math.sin(turn + LEAN)), BLADE, WIDTH)


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "wheel.obj"
    vertices, triangles = [], []
    rims = [ring(DRUM - WALL, RADIUS + 0.004, RIM, z) for z in (-WIDTH / 2, WIDTH / 2)]
    spokes = [spoke(2 * math.pi * k / SPOKES) for k in range(SPOKES)]
    blades = [blade(2 * math.pi * k / BLADES) for k in range(BLADES)]
    for part in [hub(), ring(DRUM - WALL, DRUM, WIDTH, 0.0)] + rims + spokes + blades:
        base = len(vertices)
        vertices += part[0]
        triangles += [tuple(base + i for i in triangle) for triangle in part[1]]
    mesh_tools.write_obj(path, "wheel", "An overshot wheel, written by make_wheel.py.", (vertices, triangles))


if __name__ == "__main__":
    main()
