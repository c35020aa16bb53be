"""Which runs stay finite: factor on a parameter against time step, one panel per parameter.

Usage: extremes.py extremes.csv extremes.png
"""

import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOURS = {"finite": "tab:green", "stopped": "tab:orange", "refused": "tab:grey", "LEAKED": "tab:red"}
table, picture = sys.argv[1:]
with open(table) as file:
    rows = list(csv.DictReader(file))
names = list(dict.fromkeys(row["parameter"] for row in rows))
figure, axes = plt.subplots(1, len(names), figsize=(3.4 * len(names), 3.6), sharey=True)
for axis, name in zip(axes, names):
    for ending, colour in COLOURS.items():
        mine = [row for row in rows if row["parameter"] == name and row["ending"] == ending]
        axis.scatter([math.log10(float(row["factor"])) for row in mine], [math.log10(float(row["step_s"])) for row in mine],
                     marker="s", s=60, color=colour, label=ending if mine else None)
    axis.set_title(name, fontsize=10)
    axis.set_xlabel("factor, decades")
    axis.legend(fontsize=7, loc="upper left")
axes[0].set_ylabel("step, log10 s")
figure.tight_layout()
figure.savefig(picture, dpi=130)
