"""The knots that the simulated operator ties, drawn from the loose knots in scenes/shapes."""

import sys

import numpy as np
from drawing import BLUE, GREY, ORANGE, ROOT, sheet, write

sys.path.insert(0, str(ROOT / "scenes/shapes"))
import loose_knots  # noqa: E402

WIDE, HIGH = 158, 136       # points, of a panel
LINE, EDGE = 5.0, 9.0      # points: width of the strand, and of the gap that it cuts into the strand below
POINT = 0.9                 # points: distance of the curve's points on the paper
PIECE = 9                   # points of the curve drawn again on either side of a crossing


def thrown(throws):
    """A knot of throws with a loop below, from the front: right and up in points, and the height above the paper."""
    curve = np.array(loose_knots.loose(throws, 0.3))
    curve = curve[np.abs(curve[:, 0]) < 0.0205]
    return np.stack([3500 * curve[:, 0], 3500 * curve[:, 2], -curve[:, 1]], axis=1)


def eight():
    """The figure-eight of the desk's scene from above, turned until its ends are level, and drawn a little higher."""
    curve = np.loadtxt(ROOT / "scenes/shapes/figure-eight-on-desk.csv", delimiter=",", skiprows=2)
    curve = curve[(curve[:, 0] > 0.2431) & (curve[:, 0] < 1.3)]
    turn = np.radians(60.0)
    x, y, z = curve.T
    right, up = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    return np.stack([150 * right, 185 * up, z], axis=1)


KNOTS = (("overhand", "3_1", lambda: thrown("throws=3"), 3),  # name, type, curve, number of crossings
         ("figure-eight", "4_1", eight, 4),
         ("square", "3_1 # its mirror image", lambda: thrown("square"), 6),
         ("granny", "3_1 # 3_1", lambda: thrown("granny"), 6),
         ("surgeon's", "5_1 # mirrored 3_1", lambda: thrown("surgeons"), 8))


def even(curve):
    """The curve with points equally far apart on the paper, and its middle at the origin."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve[:, :2], axis=0), axis=1))])
    at = np.linspace(0.0, along[-1], 1 + round(along[-1] / POINT))
    curve = np.stack([np.interp(at, along, c) for c in curve.T], axis=1)
    return curve - [*(curve[:, :2].min(axis=0) + curve[:, :2].max(axis=0)) / 2, 0.0]


def crossings(curve):
    """Index of the upper segment at each place where the curve crosses itself on the paper."""
    start, step, height = curve[:-1, :2], np.diff(curve[:, :2], axis=0), curve[:, 2]
    upper = []
    for i in range(len(step) - 2):
        to = start[i + 2:] - start[i]
        across = step[i, 0] * step[i + 2:, 1] - step[i, 1] * step[i + 2:, 0]
        across = np.where(across == 0.0, np.nan, across)  # parallel segments do not cross: comparisons with NaN fail
        s = (to[:, 0] * step[i + 2:, 1] - to[:, 1] * step[i + 2:, 0]) / across
        t = (to[:, 0] * step[i, 1] - to[:, 1] * step[i, 0]) / across
        for j in np.flatnonzero((s >= 0) & (s < 1) & (t >= 0) & (t < 1)) + i + 2:
            upper.append(i if height[i] > height[j] else int(j))
    return upper


def line(axes, flat, first, last, width, colour=None):
    """A part of the curve, from point `first` to before `last`: its first half blue and its second half orange."""
    half = len(flat) // 2
    for a, b, own in ((0, half + 1, BLUE), (half, len(flat), ORANGE)):
        part = flat[max(a, first):min(b, last)]
        if len(part) > 1:
            axes.plot(*part.T, color=colour or own, linewidth=width, solid_capstyle="butt", solid_joinstyle="round")


def draw():
    figure, axes = sheet(WIDE * len(KNOTS), HIGH + 44)
    for k, (name, kind, shape, least) in enumerate(KNOTS):
        curve = even(shape())
        upper = crossings(curve)
        assert len(upper) == least, (name, len(upper))
        flat = curve[:, :2] + (WIDE * (k + 0.5), HIGH / 2 + 42)
        line(axes, flat, 0, len(flat), LINE)
        for i in upper:
            line(axes, flat, i - PIECE, i + PIECE + 2, EDGE, "white")
            line(axes, flat, i - PIECE - 2, i + PIECE + 4, LINE)
        write(axes, WIDE * (k + 0.5), 34, name, weight="bold")
        write(axes, WIDE * (k + 0.5), 16, kind, GREY, size=9)
    return figure
