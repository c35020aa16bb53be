"""How the simulated operator ties a figure-eight in a stiff thread: three stages, from the front."""

import numpy as np
from drawing import BLUE, GREY, ORANGE, sheet, write
from knots import EDGE, LINE, PIECE, crossings

WIDE, HIGH, SCALE = 265, 178, 2.0  # points: a panel; points per mm
STANDING = ((0, 0, 0), (-50, 2, 0), (-92, 4, 0))  # mm: to the right of the anchor, up, to the front
LOOP = ((-101, 0, 0), (-104, -13, 0), (-97, -26, 0), (-80, -31, 0), (-62, -24, 0), (-50, -8, 8), (-41, 9, 8),
        (-32, 13, 0), (-24, 4, -8))
STAGES = (  # name, way of the end after the crossing, number of crossings that are seen
    ("after move 1", ((-22, -8, -12), (-25, -22, -14), (-30, -34, -14)), 2),
    ("after move 2", ((-22, -10, -12), (-25, -28, -6), (-38, -42, 6), (-54, -46, 14)), 2),
    ("after move 4", ((-22, -10, -12), (-27, -27, 0), (-42, -33, 10), (-58, -27, 12), (-72, -17, 8), (-90, -10, -8),
                      (-116, -12, -12)), 4),
)


def smooth(points):
    """A Catmull-Rom spline through the points."""
    p = np.array([points[0], *points, points[-1]], dtype=float)
    t = np.linspace(0.0, 1.0, 40, endpoint=False)[:, None]
    parts = [0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
             for a, b, c, d in zip(p, p[1:], p[2:], p[3:])]
    return np.concatenate([*parts, p[-1:]])


def line(axes, flat, corner, first, last, width, colour=None):
    """A part of the thread: the standing part, up to the point `corner`, in blue, the working part in orange."""
    for a, b, own in ((0, corner + 1, BLUE), (corner, len(flat), ORANGE)):
        part = flat[max(a, first):min(b, last)]
        if len(part) > 1:
            axes.plot(*part.T, color=colour or own, linewidth=width, solid_capstyle="butt", solid_joinstyle="round")


def draw():
    figure, axes = sheet(WIDE * len(STAGES), HIGH + 20)
    for k, (name, way, seen) in enumerate(STAGES):
        curve = smooth((*STANDING, *LOOP, *way))
        corner = 40 * len(STANDING)
        upper = crossings(curve)
        assert len(upper) == seen, (name, len(upper))
        flat = SCALE * curve[:, :2] + (WIDE * (k + 1) - 22, HIGH - 40)
        line(axes, flat, corner, 0, len(flat), LINE)
        for i in upper:
            line(axes, flat, corner, i - PIECE, i + PIECE + 2, EDGE, "white")
            line(axes, flat, corner, i - PIECE - 2, i + PIECE + 4, LINE)
        for at, what, up in ((0, "anchor", 16), (corner, "corner", 16), (-1, "end", -14)):
            axes.plot(*flat[at], "o", color="black", markersize=7)
            write(axes, *(flat[at] + (0, up)), what, GREY, size=9)
        write(axes, WIDE * (k + 0.5), 12, name, weight="bold")
    write(axes, WIDE - 145, HIGH - 22, "standing part", BLUE, size=9)
    write(axes, WIDE - 172, HIGH - 117, "working part", ORANGE, size=9)
    return figure
