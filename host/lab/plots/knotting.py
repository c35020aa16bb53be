"""Each script's thread as it is tied, seen from the front and the side. Usage: knotting.py shapes.csv knotting.png"""

import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

NAMES = ["overhand", "overhand, mirrored", "figure-eight", "figure-eight, mirrored"]
table, picture = sys.argv[1:]
shapes = defaultdict(lambda: defaultdict(list))
with open(table) as file:
    for row in csv.DictReader(file):
        shapes[int(float(row["script"]))][float(row["t_s"])].append([float(row[k]) for k in ("x_m", "y_m", "z_m")])
columns = max(len(times) for times in shapes.values())
figure = plt.figure(figsize=(2.3 * columns, 3.6 * len(shapes)))
for line, (script, times) in enumerate(sorted(shapes.items())):
    for column, (t, points) in enumerate(sorted(times.items())):
        axis = figure.add_subplot(len(shapes), columns, line * columns + column + 1, projection="3d")
        x, y, z = zip(*points)
        axis.plot(x, y, z, color="firebrick", linewidth=2)
        axis.set_xlim(-1.5, 1.5)
        axis.set_ylim(-1.5, 1.5)
        axis.set_zlim(0.5, 5.6)
        axis.set_box_aspect((3, 3, 5), zoom=1.7)
        axis.view_init(12, -75)
        axis.set_axis_off()
        axis.set_title(f"{NAMES[script]}\n{t:.1f} s" if column == 0 else f"{t:.1f} s", fontsize=9)
figure.tight_layout()
figure.savefig(picture, dpi=110)
