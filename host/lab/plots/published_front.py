"""CPU time of a tick against the largest error of each published case. Usage: published_front.py front.csv front.png"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LEAST, MOST = 0.01, 100.0  # errors outside are drawn at these bounds: 0, and yes-or-no figures that miss
MARKS = {"fast": "v", "balanced": "o", "fine": "x"}
table, picture = sys.argv[1:]
with open(table) as file:
    rows = list(csv.DictReader(file))
figure, axis = plt.subplots(figsize=(8, 5.4))
for k, case in enumerate(dict.fromkeys(row["case"] for row in rows)):
    mine = sorted((row for row in rows if row["case"] == case), key=lambda row: float(row["tick_us"]))
    cost = [float(row["tick_us"]) for row in mine]
    error = [min(max(float(row["error_tolerances"]), LEAST), MOST) for row in mine]
    axis.plot(cost, error, color=f"C{k % 10}", linestyle="-" if k < 10 else "--", linewidth=0.8, label=case)
    for row, x, y in zip(mine, cost, error):
        axis.plot(x, y, MARKS.get(row["setting"], "s"), color=f"C{k % 10}", markersize=5)
axis.axhline(1.0, color="black", linewidth=1, linestyle=":")
axis.annotate("tolerance", (0.01, 1.0), xycoords=("axes fraction", "data"), textcoords="offset points", xytext=(0, 3))
axis.axvline(1000.0, color="black", linewidth=1, linestyle="--")
axis.annotate("1 kHz", (1000.0, 0.02), xycoords=("data", "axes fraction"), textcoords="offset points", xytext=(3, 0))
axis.set_xscale("log")
axis.set_yscale("log")
axis.set_ylim(0.7 * LEAST, 1.4 * MOST)
axis.set_xlabel("CPU time of a 1 ms tick, us, mean of the case")
axis.set_ylabel("largest error, tolerances")
axis.set_title("Published cases. v fast, o balanced, squares: balanced with another budget, x fine", fontsize=9)
axis.legend(fontsize=7)
axis.grid(alpha=0.3, which="both", linewidth=0.4)
figure.tight_layout()
figure.savefig(picture, dpi=130)
