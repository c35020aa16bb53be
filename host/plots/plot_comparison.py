"""Draws two tables of `ligature-host export --forces` over each other: force on each hand, and what differs.

python3 plot_comparison.py a.csv NAME_A b.csv NAME_B --out both.png [--align start|grasp] [--shift S]
Needs numpy and matplotlib. Prints one line a hand.
"""

import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from plot_forces import drawn, embedded, read, save, thinned

COLOURS = {"a": "#0072B2", "b": "#D55E00", "difference": "#444444"}
HANDS = ("left", "right")


def zero_of(name, column, time, align):
    """Time that becomes 0: of the first grasp for align "grasp", else of the first row."""
    if align != "grasp":
        return time[0]
    held = np.flatnonzero((column["left_node"] >= 0) | (column["right_node"] >= 0))
    if not len(held):
        raise ValueError(f"{name}: has no grasp; align by start")
    return time[held[0]]


def difference(time_a, force_a, time_b, force_b):
    """b - a at those ticks of a that lie within b's time; b is interpolated linearly."""
    both = (time_a >= time_b[0]) & (time_a <= time_b[-1])
    return time_a[both], np.interp(time_a[both], time_b, force_b) - force_a[both]


def describe(name, column, hand):
    force_N, held = column[f"{hand}_device_f_N"], column[f"{hand}_node"] >= 0
    mean = f"{force_N[held].mean():.4f} N while holding" if held.any() else "holds nothing"
    return f"{name}: peak {force_N.max():.4f} N, {mean}"


def draw(tables, out, align, shift_s):
    recordings = []
    for (path, name), later_s in zip(tables, (0.0, shift_s)):
        column, time = read(path)
        recordings.append((name, column, time - zero_of(name, column, time, align) + later_s))
    (name_a, a, time_a), (name_b, b, time_b) = recordings
    figure, axes = plt.subplots(4, 1, sharex=True, figsize=(12, 8.5), dpi=130, height_ratios=[3, 1.3, 3, 1.3],
                                layout="constrained")
    for hand, upper, lower in zip(HANDS, axes[::2], axes[1::2]):
        column = f"{hand}_device_f_N"
        upper.plot(*thinned(time_a, a[column]), color=COLOURS["a"], linewidth=1.1, label=f"a: {name_a}")
        upper.plot(*thinned(time_b, b[column]), color=COLOURS["b"], linewidth=1.1, linestyle="--", label=f"b: {name_b}")
        upper.set_title(f"{hand} hand", loc="left", fontsize=10)
        upper.set_ylabel("|F|, N")
        upper.legend(loc="upper right", fontsize=8, frameon=False)
        time, off_N = difference(time_a, a[column], time_b, b[column])
        verdict = "no common time"
        if len(time):
            lower.plot(*thinned(time, off_N), color=COLOURS["difference"], linewidth=0.9)
            verdict = f"b - a: root mean square {np.sqrt(np.mean(off_N ** 2)):.4f} N, largest {np.abs(off_N).max():.4f} N"
        lower.axhline(0.0, color="#999999", linewidth=0.6)
        lower.set_ylabel("b - a, N")
        lower.set_title(verdict, loc="left", fontsize=9)
        print(f"{hand}: {describe('a', a, hand)}; {describe('b', b, hand)}; {verdict}")
        for axis in (upper, lower):
            axis.grid(True, color="#dddddd", linewidth=0.5)
    axes[-1].set_xlabel(f"time since the first {'grasp' if align == 'grasp' else 'tick'} of each, s")
    save(figure, out, embedded(tables[0][0]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tables", nargs=4)
    parser.add_argument("--out", required=True)
    parser.add_argument("--align", choices=("start", "grasp"), default="start")
    parser.add_argument("--shift", type=float, default=0.0, help="b later, s")
    arguments = parser.parse_args()
    return drawn(draw, (arguments.tables[:2], arguments.tables[2:]), arguments.out, arguments.align, arguments.shift)


if __name__ == "__main__":
    sys.exit(main())
