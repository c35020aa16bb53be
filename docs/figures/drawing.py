"""What the figures of docs/ share: a sheet measured in points (1/72 inch), boxes, arrows, and a reproducible SVG file.

Text stays text in the SVG. It is laid out for DejaVu Sans, a wide font, so it fits with other fonts as well."""

import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import FancyBboxPatch

ROOT = pathlib.Path(__file__).resolve().parents[2]
IMAGES = ROOT / "docs/images"

# Okabe-Ito palette: distinguishable with the common forms of colour blindness. PALE: the same colours as backgrounds.
BLUE, ORANGE, GREEN, RED, GREY, BLACK = "#0072B2", "#D55E00", "#009E73", "#882255", "#777777", "#111111"
PALE = {BLUE: "#DCEBF5", ORANGE: "#FBE3D3", GREEN: "#D9F0E8", RED: "#F1DCE6", GREY: "#EEEEEE", BLACK: "#FFFFFF"}

plt.rcParams.update({
    "svg.hashsalt": "ligature",   # the ids inside the file depend on its content only
    "svg.fonttype": "none",
    "font.family": "DejaVu Sans",
    "font.size": 11,
    "savefig.facecolor": "white",  # a ground of its own, so that a figure is readable on dark pages
})


def source(path):
    return (ROOT / path).read_text(encoding="utf-8")


def microseconds(path, name):
    """A time that the C++ code states, such as `kMargin = std::chrono::microseconds(25)`, or in a static_assert with ==."""
    return int(re.search(re.escape(name) + r" ==? std::chrono::microseconds\((\d+)\)", source(path))[1])


def sheet(width, height):
    """A white sheet with coordinates in points, the origin at the lower left."""
    figure = plt.figure(figsize=(width / 72, height / 72))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(0, width)
    axes.set_ylim(0, height)
    axes.axis("off")
    return figure, axes


def write(axes, x, y, text, colour=BLACK, align="center", size=11, **options):
    axes.text(x, y, text, color=colour, ha=align, va="center", fontsize=size, linespacing=1.25, **options)


def box(axes, x, y, width, height, text, colour=BLUE, align="center", size=11):
    """A rounded box with its lower left corner at (x, y)."""
    axes.add_patch(FancyBboxPatch((x, y), width, height, boxstyle="round,pad=0,rounding_size=5", linewidth=1.2,
                                  facecolor=PALE[colour], edgecolor=colour))
    write(axes, x + 9 if align == "left" else x + width / 2, y + height / 2, text, align=align, size=size)


def arrow(axes, points, colour=BLACK, width=1.3, style="-"):
    """A line through the points, with its head at the last one."""
    if len(points) > 2:
        axes.plot(*zip(*points[:-1]), color=colour, linewidth=width, linestyle=style, solid_joinstyle="round")
    axes.annotate("", points[-1], points[-2], arrowprops={
        "arrowstyle": "-|>,head_length=0.5,head_width=0.22", "color": colour, "linewidth": width, "linestyle": style,
        "shrinkA": 0, "shrinkB": 0})


def save(figure, path):
    """Writes SVG without a date, or PNG if the path ends so."""
    if path.suffix == ".svg":
        figure.savefig(path, format="svg", metadata={"Date": None, "Creator": None})
    else:
        figure.savefig(path, dpi=120)
    plt.close(figure)
