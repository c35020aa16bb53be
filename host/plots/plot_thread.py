"""Draws a thread: whole, as the operator sees it, and each part of its knot magnified, nearer strands over farther ones.

python3 plot_thread.py shape.csv --radius M --out thread.png [--title TEXT]
shape.csv: x,y,z, metres, a row a node. Needs numpy and matplotlib.
"""

import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from plot_forces import drawn, save

NEAR = 1.5  # strands closer than this many diameters count as touching
STEP, BESIDE = 0.15, 40  # in diameters: distance of drawn points; number of points drawn before and after the knot
MOST_PARTS = 3  # of a knot that are magnified
OVERLAP = 0.4  # share of each neighbouring segment that a stroke covers
APART = 8.0  # in diameters along the thread: two places further apart belong to different strands
FROM_THE_FRONT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # direction of view: x to the right, z up


def fine(points, step):
    """The same polyline, resampled with points at most `step` apart."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0.0, along[-1], max(2, int(np.ceil(along[-1] / step))))
    return np.stack([np.interp(at, along, points[:, i]) for i in range(3)], axis=1), at


def knotted(points, along, diameter):
    """(first, last) index of each part in which strands touch, from contact to contact; the whole thread when none do.

    Parts that share points are one, so a knot is one part and two throws far from each other are two."""
    parts = []
    for i, point in enumerate(points):
        near = np.linalg.norm(points - point, axis=1) < NEAR * diameter
        touching = np.flatnonzero(near & (along - along[i] > APART * diameter))
        if not len(touching):
            continue
        if parts and i <= parts[-1][1]:
            parts[-1][1] = max(parts[-1][1], touching[-1])
        else:
            parts.append([i, touching[-1]])
    return parts or [[0, len(points) - 1]]


def flattest(points):
    """The two principal directions in which the points spread most."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return axes[:2]


def draw_strands(axis, points, share, view, width_m):
    """Draws segments from back to front, each with a pale outline that separates it from what lies behind.

    Each stroke bends into both neighbours of its segment, so that a strand shows neither seams nor, where it turns
    sharply, gaps."""
    depth = points @ np.cross(*view)  # depth towards the viewer: right x up
    flat = points @ view.T
    before = np.vstack([flat[:1], flat[:-2] + (1.0 - OVERLAP) * np.diff(flat[:-1], axis=0)])
    after = np.vstack([flat[1:-1] + OVERLAP * np.diff(flat[1:], axis=0), flat[-1:]])
    strokes = np.stack([before, flat[:-1], flat[1:], after], axis=1)
    middle = (depth[:-1] + depth[1:]) / 2
    order = np.argsort(np.concatenate([middle - width_m / 2, middle]))  # outlines lie behind their own strand
    colours = plt.get_cmap("viridis")(0.9 * (share - share.min()) / np.ptp(share))
    left, right = axis.get_xlim()
    points_per_m = axis.bbox.width / axis.figure.dpi * 72.0 / (right - left)
    width = max(width_m * points_per_m, 1.2)
    lines = np.concatenate([strokes, strokes])[order]
    paints = np.concatenate([np.ones((len(strokes), 4)), colours])[order]
    widths = np.repeat([width + 2.0, width], len(strokes))[order]
    axis.add_collection(LineCollection(lines, colors=paints, linewidths=widths, capstyle="butt", joinstyle="round"))


def frame(axis, flat, margin):
    """Sets equal scales on both axes; the shorter direction gets a wider margin."""
    low, high = flat.min(axis=0) - margin, flat.max(axis=0) + margin
    middle, half = (low + high) / 2, (high - low) / 2
    ratio = axis.bbox.width / axis.bbox.height
    half_y = max(half[1], half[0] / ratio)
    axis.set_xlim(middle[0] - ratio * half_y, middle[0] + ratio * half_y)
    axis.set_ylim(middle[1] - half_y, middle[1] + half_y)


def scale_bar(axis):
    """Draws a scale bar of a round length (1, 2 or 5 times a power of ten), at most a fifth of the width."""
    left, right = axis.get_xlim()
    low, high = axis.get_ylim()
    room = 0.2 * (right - left)
    length = max(step * 10.0 ** power for power in range(-6, 3) for step in (1, 2, 5) if step * 10.0 ** power <= room)
    x, y = left + 0.05 * (right - left), low + 0.04 * (high - low)
    axis.plot([x, x + length], [y, y], color="black", linewidth=2, solid_capstyle="butt")
    name = f"{length * 1e3:g} mm" if length < 0.1 else f"{length:g} m"
    axis.annotate(name, (x + length / 2, y), xytext=(0, 4), textcoords="offset points", ha="center", fontsize=9)


def draw(path, radius, out, title):
    points = np.loadtxt(path, delimiter=",", ndmin=2)
    diameter = 2.0 * radius
    points, along = fine(points, STEP * diameter)
    share = (along[:-1] + along[1:]) / 2 / along[-1]
    panels = [("from the front", points, share, FROM_THE_FRONT, 0.05 * np.ptp(points, axis=0).max())]
    parts = knotted(points, along, diameter)[:MOST_PARTS]
    for k, (first, last) in enumerate(parts):
        near = slice(max(0, first - BESIDE), last + BESIDE + 1)
        name = "the knot" if len(parts) == 1 else f"the knot, part {k + 1} of {len(parts)}"
        panels.append((name, points[near], share[near], flattest(points[first:last + 1]), 4.0 * diameter))
    figure, axes = plt.subplots(1, len(panels), figsize=(12, 7), dpi=130, width_ratios=[1] + [2 / len(parts)] * len(parts))
    figure.subplots_adjust(0.02, 0.02, 0.98, 0.9, 0.04)
    for axis, (name, shown, along_it, view, margin) in zip(axes, panels):
        frame(axis, shown @ view.T, margin)
        draw_strands(axis, shown, along_it[:len(shown) - 1], view, diameter)
        scale_bar(axis)
        axis.set_xticks([])
        axis.set_yticks([])
        axis.set_title(name, fontsize=10)
    figure.suptitle(title)
    save(figure, out, {})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shape")
    parser.add_argument("--radius", type=float, required=True, help="of the thread, m")
    parser.add_argument("--out", required=True)
    parser.add_argument("--title", default="thread")
    arguments = parser.parse_args()
    return drawn(draw, arguments.shape, arguments.radius, arguments.out, arguments.title)


if __name__ == "__main__":
    sys.exit(main())
