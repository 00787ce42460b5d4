#!/usr/bin/env python3
"""Writes hourglass.obj: the glass of an hourglass, a closed surface of revolution about the y axis.

    python3 make_hourglass.py [hourglass.obj]

The neck is at the origin. The upper half, from the neck upward, is

    a quarter turn of the neck, vertical where it is narrowest, leaning out to the funnel;
    the funnel, straight and steeper than sand can rest on;
    the bend from the funnel to the upright wall, where the bulb is widest;
    the dome, a superellipse, flat enough in the middle to stand on.

The lower half mirrors it. Triangles are counter-clockwise seen from outside. Metres.
"""

import math
import sys

NECK_RADIUS = 0.0175  # 8.4 particle spacings across at the scene's own resolution
NECK_BEND = 0.030
FUNNEL_ANGLE = math.radians(54.0)  # over the horizontal; sand of 30 degrees slides off
BULB_RADIUS = 0.114  # the neck is 1 / 6.5 of it
BULB_BEND = 0.060
DOME_HEIGHT = 0.070
DOME_EXPONENT = 2.6  # 2 is an ellipse, more is boxier

SEGMENTS = 96
RINGS_PER_HALF = 32  # the ring at the neck is shared


def fine_profile():
    """The upper half as many short steps of (radius, height), from the neck to the pole."""
    steps = 400
    points = []
    quarter = math.pi / 2
    for i in range(steps):
        lean = quarter + (FUNNEL_ANGLE - quarter) * i / steps
        points.append((NECK_RADIUS + NECK_BEND * (1 - math.sin(lean)), NECK_BEND * math.cos(lean)))
    funnel_start = (NECK_RADIUS + NECK_BEND * (1 - math.sin(FUNNEL_ANGLE)), NECK_BEND * math.cos(FUNNEL_ANGLE))
    funnel_end_radius = BULB_RADIUS - BULB_BEND * (1 - math.sin(FUNNEL_ANGLE))
    funnel_end_height = funnel_start[1] + (funnel_end_radius - funnel_start[0]) * math.tan(FUNNEL_ANGLE)
    for i in range(steps):
        share = i / steps
        points.append((funnel_start[0] + share * (funnel_end_radius - funnel_start[0]),
                       funnel_start[1] + share * (funnel_end_height - funnel_start[1])))
    widest_height = funnel_end_height + BULB_BEND * math.cos(FUNNEL_ANGLE)
    for i in range(steps):
        lean = FUNNEL_ANGLE + (quarter - FUNNEL_ANGLE) * i / steps
        points.append((BULB_RADIUS - BULB_BEND * (1 - math.sin(lean)), widest_height - BULB_BEND * math.cos(lean)))
    for i in range(steps + 1):
        turn = quarter * i / steps
        points.append((BULB_RADIUS * max(math.cos(turn), 0.0) ** (2 / DOME_EXPONENT),
                       widest_height + DOME_HEIGHT * math.sin(turn) ** (2 / DOME_EXPONENT)))
    points[-1] = (0.0, points[-1][1])
    return points


def evenly_spaced(points, count):
    """`count` points at equal arc length along the polyline, its two ends included."""
    lengths = [0.0]
    for a, b in zip(points, points[1:]):
        lengths.append(lengths[-1] + math.dist(a, b))
    result = []
    k = 0
    for i in range(count):
        goal = lengths[-1] * i / (count - 1)
        while k + 2 < len(points) and lengths[k + 1] < goal:
            k += 1
        share = (goal - lengths[k]) / (lengths[k + 1] - lengths[k])
        result.append(tuple(a + share * (b - a) for a, b in zip(points[k], points[k + 1])))
    result[-1] = points[-1]
    return result


def hourglass():
    """Vertices and triangles (indices from 0)."""
    half = evenly_spaced(fine_profile(), RINGS_PER_HALF + 1)
    top = half[-1][1]
    upper = half[:-1]  # without the pole
    rings = [(radius, -height) for radius, height in reversed(upper[1:])] + upper

    vertices = [(0.0, -top, 0.0)]
    for radius, height in rings:
        for s in range(SEGMENTS):
            turn = 2 * math.pi * s / SEGMENTS
            vertices.append((radius * math.cos(turn), height, radius * math.sin(turn)))
    vertices.append((0.0, top, 0.0))

    def at(ring, segment):
        return 1 + ring * SEGMENTS + segment % SEGMENTS

    triangles = []
    last = len(rings) - 1
    for s in range(SEGMENTS):
        triangles.append((0, at(0, s), at(0, s + 1)))
        for ring in range(last):
            a, b = at(ring, s), at(ring, s + 1)
            c, d = at(ring + 1, s), at(ring + 1, s + 1)
            triangles.append((a, c, b))
            triangles.append((b, c, d))
        triangles.append((len(vertices) - 1, at(last, s + 1), at(last, s)))
    return vertices, triangles


def signed_volume(vertices, triangles):
    total = 0.0
    for i, j, k in triangles:
        a, b, c = vertices[i], vertices[j], vertices[k]
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                  + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return total / 6


def check(vertices, triangles):
    """Stops if the surface is not closed, not outward, or has a triangle without area."""
    edges = set()
    for triangle in triangles:
        for i in range(3):
            edge = (triangle[i], triangle[(i + 1) % 3])
            assert edge not in edges, f"edge {edge} is used twice in the same direction"
            edges.add(edge)
        a, b, c = (vertices[i] for i in triangle)
        u = [b[i] - a[i] for i in range(3)]
        v = [c[i] - a[i] for i in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        assert math.hypot(*normal) > 1e-9, f"triangle {triangle} has no area"
    assert all((b, a) in edges for a, b in edges), "the surface is open"
    assert signed_volume(vertices, triangles) > 0, "the surface is inside out"


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "hourglass.obj"
    vertices, triangles = hourglass()
    check(vertices, triangles)
    with open(path, "w", encoding="ascii") as file:
        file.write("# An hourglass, written by make_hourglass.py. Metres, y is up, the neck is at the origin.\n")
        file.write("o hourglass\n")
        for vertex in vertices:
            file.write("v %.6f %.6f %.6f\n" % vertex)
        for triangle in triangles:
            file.write("f %d %d %d\n" % tuple(i + 1 for i in triangle))
    height = max(v[1] for v in vertices) * 2
    print(f"{path}: {len(vertices)} vertices, {len(triangles)} triangles, {height:.3f} m high, "
          f"{2 * BULB_RADIUS:.3f} m wide, neck {2 * NECK_RADIUS:.3f} m, "
          f"{1000 * signed_volume(vertices, triangles):.2f} litres")


if __name__ == "__main__":
    main()
