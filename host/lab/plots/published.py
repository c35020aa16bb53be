"""Theory and measurement of one published experiment in one plot. Usage: published.py CASE.csv CASE.png"""

import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MARKS = {"balanced": ("o", "none"), "fine": ("x", None), "fast": ("^", "none")}
table, picture = sys.argv[1:]
with open(table) as file:
    rows = list(csv.DictReader(file))
figure, axis = plt.subplots(figsize=(9, 5))
curves = list(dict.fromkeys(row["curve"] for row in rows))
settings = list(dict.fromkeys(row["setting"] for row in rows))
for k, curve in enumerate(curves):
    mine = [row for row in rows if row["curve"] == curve]
    colour = f"C{k % 10}"
    theory = sorted({(float(row["x"]), float(row["theory"])) for row in mine if not math.isnan(float(row["theory"]))})
    if theory:
        axis.plot(*zip(*theory), color=colour, label=f"{curve}, theory")
    for setting in settings:
        mark, face = MARKS.get(setting, ("sDvP"[settings.index(setting) % 4], "none"))
        points = [(float(row["x"]), float(row["measured"])) for row in mine
                  if row["setting"] == setting and not math.isnan(float(row["measured"]))]
        if points:
            axis.plot(*zip(*points), mark, color=colour, markerfacecolor=face, label=f"{curve}, {setting}")
if rows:
    axis.set_xlabel(rows[0]["x_axis"])
    axis.set_ylabel(rows[0]["y_axis"])
    axis.set_title(rows[0]["title"], fontsize=9)
    values = [float(row[key]) for row in rows for key in ("theory", "measured")]
    shown = [value for value in values if not math.isnan(value)]
    if min(shown) > 0 and max(shown) > 30 * min(shown):
        axis.set_yscale("log")
    axis.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.01, 1.0))  # beside the plot: it would hide points
axis.grid(alpha=0.3, which="both")
figure.tight_layout()
figure.savefig(picture, dpi=130)
