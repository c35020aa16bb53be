"""Force in each haptic frame (tick); the background shows the paper's condition of force propagation, A, B or C.
Usage: pulling.py frames.csv pulling.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

NAMES = ["one-hand pulling", "two-hand pulling"]
COLOURS = {1: ("A", "#e8f4e8"), 2: ("B", "#fdf0d5"), 3: ("C", "#f9dcdc")}
table, picture = sys.argv[1:]
pulls = [{"frame": [], "left": [], "right": [], "condition": []} for _ in NAMES]
with open(table) as file:
    for row in csv.DictReader(file):
        pull = pulls[int(float(row["pull"]))]
        pull["frame"].append(float(row["frame"]))
        pull["left"].append(float(row["left_N"]))
        pull["right"].append(float(row["right_N"]))
        pull["condition"].append(int(float(row["condition"])))
figure, axes = plt.subplots(1, 2, figsize=(12, 4), sharey=True)
for axis, name, pull in zip(axes, NAMES, pulls):
    frames, conditions = pull["frame"], pull["condition"]
    start = 0
    for k in range(1, len(frames) + 1):
        if k == len(frames) or conditions[k] != conditions[start]:
            if conditions[start] in COLOURS:
                axis.axvspan(frames[start], frames[k - 1], color=COLOURS[conditions[start]][1], linewidth=0)
            start = k
    if any(pull["left"]):
        axis.plot(frames, pull["left"], label="left hand", linewidth=1)
    axis.plot(frames, pull["right"], label="right hand", linewidth=1, color="firebrick")
    axis.axhline(3.3, color="grey", linestyle="--", linewidth=1)
    for label, colour in COLOURS.values():
        axis.fill_between([], [], color=colour, label=f"condition {label}")
    axis.set_title(name)
    axis.set_xlabel("haptic frame (1 ms)")
    axis.legend(fontsize=8, loc="upper left")
axes[0].set_ylabel("force at the device, N")
figure.tight_layout()
figure.savefig(picture, dpi=130)
