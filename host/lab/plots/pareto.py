"""CPU time of a tick against error, every model, with Pareto fronts; the front of published experiments beside them.

Usage: pareto.py pareto.csv [pareto-published.csv] pareto.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def rows_of(table):
    with open(table) as file:
        return list(csv.DictReader(file))


def draw_published(axis, settings):
    """Settings of the rod by their cost and by the share of published figures that they miss."""
    places = [(float(s["tick_us"]), 100.0 * float(s["missed"]) / float(s["judged"])) for s in settings]
    for s, place in zip(settings, places):
        axis.plot(*place, "k*" if s["setting"] in ("fast", "balanced", "fine") else "ko", markersize=10)
        axis.annotate(s["setting"], place, textcoords="offset points", xytext=(6, 6), fontsize=9)
    best = sorted(place for s, place in zip(settings, places) if s["front"] == "1")
    axis.step([b[0] for b in best], [b[1] for b in best], where="post", color="firebrick")
    axis.set_xscale("log")
    axis.set_xlim(0.7 * min(p[0] for p in places), 2.0 * max(p[0] for p in places))
    axis.set_ylim(bottom=0.0)
    axis.axvline(1000.0, color="black", linestyle="--", linewidth=1)
    axis.set_xlabel("CPU time of a 1 ms tick, us: mean of the published cases")
    axis.set_ylabel("figures of published experiments that are missed (%)")
    axis.grid(alpha=0.3, which="both", linewidth=0.4)


*tables, picture = sys.argv[1:]
rows = rows_of(tables[0])
models = sorted({row["model"] for row in rows})
colours = {"paper-1": "#9ecae1", "paper-2": "#6baed6", "paper-3": "#4292c6", "paper-4": "#2171b5", "paper-5": "#08306b",
           "rod": "firebrick"}
panels = (("motion_of_L", "motion_front", "error of shape and swing, of L", 100.0, "%"),
          ("knot_diameters", "knot_front", "error of the held knot's length, diameters", 1.0, ""))
figure, axes = plt.subplots(1, 1 + len(tables), figsize=(6.5 * (1 + len(tables)), 5.4))
if len(tables) > 1:
    draw_published(axes[2], rows_of(tables[1]))
for axis, (error, front, label, factor, unit) in zip(axes, panels):
    for model in models:
        mine = [row for row in rows if row["model"] == model and row[error]]
        cost = [float(row["median_us"]) for row in mine]
        wrong = [max(factor * float(row[error]), 1e-4) for row in mine]
        axis.scatter(cost, wrong, s=12, color=colours[model], alpha=0.45)
        best = sorted((float(row["median_us"]), max(factor * float(row[error]), 1e-4), float(row["worst_us"])) for row in mine if row[front] == "1")
        if best:
            axis.step([b[0] for b in best], [b[1] for b in best], where="post", color=colours[model], label=model)
            axis.hlines([b[1] for b in best], [b[0] for b in best], [b[2] for b in best], color=colours[model], linewidth=0.5)
    for row in rows:
        if row["preset"] and row[error] and row["nodes"] == "154":
            x, y = float(row["median_us"]), max(factor * float(row[error]), 1e-4)
            axis.plot(x, y, "k*", markersize=10)
            axis.annotate(row["preset"], (x, y), textcoords="offset points", xytext=(6, 6), fontsize=9)
    axis.axvline(1000.0, color="black", linestyle="--", linewidth=1)
    axis.annotate("1 kHz", (1000.0, 0.02), xycoords=("data", "axes fraction"), textcoords="offset points", xytext=(3, 0))
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel("CPU time of a 1 ms tick, us: median (thin line: to the worst)")
    axis.set_ylabel(label + (f" ({unit})" if unit else ""))
    axis.grid(alpha=0.3, which="both", linewidth=0.4)
    axis.legend(fontsize=8, loc="upper right")
figure.suptitle("Lines: fronts. Stars: the rod's `accuracy` at 154 nodes. Errors are against each model's own finest setting.", fontsize=10)
figure.tight_layout()
figure.savefig(picture, dpi=130)
