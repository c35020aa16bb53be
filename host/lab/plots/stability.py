"""Largest stable step against the number of nodes. Usage: stability.py stability.csv stability.png"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

table, picture = sys.argv[1:]
with open(table) as file:
    rows = list(csv.DictReader(file))
nodes = [20, 35, 50, 100]
schemes = sorted({row["scheme"] for row in rows})
figure, axes = plt.subplots(1, len(schemes), figsize=(4.5 * len(schemes), 4), sharey=True)
for axis, scheme in zip(axes, schemes):
    for row in rows:
        if row["scheme"] == scheme:
            axis.loglog(nodes, [float(row[f"N={n}_ms"]) for n in nodes], "o-", label=row["model"])
    axis.axhline(1.0, color="grey", linestyle="--", linewidth=1)
    axis.set_title(scheme, fontsize=10)
    axis.set_xticks(nodes, [str(n) for n in nodes])
    axis.minorticks_off()
    axis.set_xlabel("nodes")
    axis.grid(alpha=0.3)
axes[0].set_ylabel("largest stable step, ms")
axes[0].legend(fontsize=8)
figure.tight_layout()
figure.savefig(picture, dpi=130)
