"""Draws force and energy at both device ports, one row per run.

Usage: haptics_ports.py haptics-ports.csv haptics-ports-table.csv out.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

traces, table, picture = sys.argv[1:]
with open(table) as file:
    names = list(dict.fromkeys(row["run"] for row in csv.DictReader(file)))
runs = {}
with open(traces) as file:
    for row in csv.DictReader(file):
        runs.setdefault((int(float(row["run"])), int(float(row["controller"]))), []).append(row)
numbers = sorted({number for number, _ in runs})
figure, axes = plt.subplots(len(numbers), 2, figsize=(12, 1.7 * len(numbers)), sharex=True, squeeze=False)
for line, number in enumerate(numbers):
    for controller, colour in ((0, "#d55e00"), (1, "#0072b2")):
        rows = runs.get((number, controller), [])
        t = [float(r["t_s"]) for r in rows]
        name = "controller " + ("on" if controller else "off")
        force = [max(float(r["left_N"]), float(r["right_N"])) for r in rows]  # in the last run one hand holds nothing
        axes[line][0].plot(t, force, color=colour, lw=0.8, label=name)
        energy = [min(float(r["left_uJ"]), float(r["right_uJ"])) for r in rows]
        axes[line][1].plot(t, energy, color=colour, lw=0.8, label=name)
    axes[line][1].axhline(0.0, color="k", lw=0.6)
    axes[line][1].set_yscale("symlog", linthresh=10.0)
    axes[line][0].set_title(names[line], fontsize=9, loc="left", pad=2)
    for axis in axes[line]:
        axis.tick_params(labelsize=7)
        axis.grid(alpha=0.3)
axes[0][0].legend(fontsize=8)
axes[0][0].set_title(names[0] + " | force at the hand that feels more, N", fontsize=9, loc="left", pad=2)
axes[0][1].set_title("energy taken in at the port, the lower one of both, uJ", fontsize=9, loc="left", pad=2)
axes[-1][0].set_xlabel("time, s")
axes[-1][1].set_xlabel("time, s")
figure.tight_layout()
figure.savefig(picture, dpi=110)
