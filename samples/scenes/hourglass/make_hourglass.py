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
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import mesh_tools  # noqa: E402

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
    half = evenly_spaced(fine_profile(), RINGS_PER_HALF + 1)
    top = half[-1][1]
    upper = half[:-1]  # without the pole
    rings = [(radius, -height) for radius, height in reversed(upper[1:])] + upper
    return mesh_tools.revolve(rings, -top, top, SEGMENTS)


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "hourglass.obj"
    mesh_tools.write_obj(path, "hourglass", "An hourglass, written by make_hourglass.py. Metres, y is up, the neck is at the origin.",
                         hourglass(), digits=6)


if __name__ == "__main__":
    main()
