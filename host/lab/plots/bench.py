"""CPU time of a tick against the number of nodes N, log-log. Usage: bench.py bench.csv bench.png"""

import csv
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

table, picture = sys.argv[1:]
with open(table) as file:
    rows = list(csv.DictReader(file))
figure, axis = plt.subplots(figsize=(6, 4.5))
for case, colour in (("free", "tab:blue"), ("coiled", "firebrick")):
    mine = [row for row in rows if row["case"] == case]
    nodes = [float(row["nodes"]) for row in mine]
    axis.loglog(nodes, [float(row["median_us"]) for row in mine], "o-", color=colour, label=f"{case}, median")
    axis.loglog(nodes, [float(row["p99_us"]) for row in mine], ":", color=colour, label=f"{case}, p99")
base = float(rows[0]["median_us"])
axis.loglog(nodes, [base * n * math.log(n) / (20 * math.log(20)) for n in nodes], color="grey", linestyle="--", label="N log N")
axis.set_xlabel("nodes")
axis.set_ylabel("CPU time of a tick, us")
axis.legend(fontsize=8)
axis.grid(alpha=0.3, which="both")
figure.tight_layout()
figure.savefig(picture, dpi=130)
