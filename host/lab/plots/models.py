"""The paper's five models side by side, released from the horizontal; a shape every 0.1 s.
Usage: models.py models-shapes.csv models.png
"""

import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

table, picture = sys.argv[1:]
shapes = defaultdict(lambda: ([], []))
with open(table) as file:
    for row in csv.DictReader(file):
        x, z = shapes[int(float(row["model"])), float(row["t_s"])]
        x.append(float(row["x_m"]))
        z.append(float(row["z_m"]))
last = max(t for _, t in shapes)
figure, axes = plt.subplots(1, 5, figsize=(16, 4.2), sharex=True, sharey=True)
for (model, t), (x, z) in sorted(shapes.items()):
    axes[model - 1].plot(x, z, color=plt.cm.viridis(t / last), linewidth=1)
for model, axis in enumerate(axes, 1):
    axis.set_title(f"model {model}")
    axis.set_xlabel("x, m")
    axis.set_aspect("equal")
axes[0].set_ylabel("z, m")
figure.suptitle("Let go from level: shape every 0.1 s, dark to light over 2 s")
figure.tight_layout()
figure.savefig(picture, dpi=130)
