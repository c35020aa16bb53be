"""Which pulls open the knot, by node and direction; and the thread on the desk before and after a pull.
Usage: unknotting.py map.csv desk.csv unknotting.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

DIRECTIONS = ["+x", "-x", "+y", "-y", "+z", "-z"]
TITLES = ["figure-eight on the desk", "right node pulled", "wrong node pulled"]
map_table, desk_table, picture = sys.argv[1:]
with open(map_table) as file:
    pulls = list(csv.DictReader(file))
with open(desk_table) as file:
    shapes = list(csv.DictReader(file))
figure = plt.figure(figsize=(13, 8))
grid = figure.add_gridspec(2, 6)
for line, knot in enumerate(["3_1", "4_1"]):
    axis = figure.add_subplot(grid[0, 3 * line : 3 * line + 3])
    mine = [p for p in pulls if p["knot"] == knot]
    for after, colour in (("0_1", "#0072B2"), ("", "#E69F00")):  # distinguishable with colour blindness
        chosen = [p for p in mine if (p["after"] == "0_1") == (after == "0_1")]
        axis.scatter([int(float(p["node"])) for p in chosen], [DIRECTIONS.index(p["direction"]) for p in chosen], marker="s", s=28,
                     color=colour, label="unties" if after else "stays knotted")
    axis.set_yticks(range(6), DIRECTIONS)
    axis.set_xlabel("node pulled")
    axis.set_title(f"{knot}: which pulls untie (frame at node 0)")
    axis.legend(fontsize=8, loc="lower center", bbox_to_anchor=(0.5, -0.32), ncol=2)
for column, title in enumerate(TITLES):
    axis = figure.add_subplot(grid[1, 2 * column : 2 * column + 2], projection="3d")
    points = [[float(s[k]) for k in ("x_m", "y_m", "z_m")] for s in shapes if int(float(s["picture"])) == column]
    if points:
        axis.plot(*zip(*points), color="firebrick", linewidth=2)
    axis.set_title(title, fontsize=10)
    axis.set_xlim(-0.5, 2.5)
    axis.set_ylim(-1.5, 1.5)
    axis.set_zlim(0, 2)
    axis.set_box_aspect((3, 3, 2))
    axis.view_init(35, -70)
figure.tight_layout()
figure.savefig(picture, dpi=120)
