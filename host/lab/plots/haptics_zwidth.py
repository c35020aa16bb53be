"""Draws which walls the loop renders stably (Z-width).

Usage: haptics_zwidth.py haptics-zwidth.csv haptics-wall-reference.csv out.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sweep, reference, picture = sys.argv[1:]
T_S, DEVICE_B = 1e-3, 0.3


def rows_of(path):
    with open(path) as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


rows = rows_of(sweep)
figure, axes = plt.subplots(2, 4, figsize=(15, 7), sharex=True, sharey=True)
for line, controller in enumerate((0, 1)):
    for delay in range(4):
        axis = axes[line][delay]
        chosen = [r for r in rows if r["controller"] == controller and r["delay_samples"] == delay]
        if not chosen:
            axis.axis("off")
            text = "the wire itself delays by one sample:\nwith the controller there is no delay of 0"
            axis.text(0.5, 0.5, text, ha="center", va="center", transform=axis.transAxes, fontsize=9)
            continue
        for stable, colour, name in ((1, "#0072b2", "settles"), (0, "#d55e00", "keeps swinging")):
            points = [(r["B_N_s_per_m"], r["K_N_per_m"]) for r in chosen if r["stable"] == stable]
            if points:
                axis.scatter(*zip(*points), s=14, color=colour, marker="o" if stable else "x", label=name)
        b = np.linspace(0, DEVICE_B, 50)
        if delay == 0:
            axis.plot(b, np.maximum(2 * (DEVICE_B - b) / T_S, 1), "k-", label="passive: b = KT/2 + |B|")
        bound = np.linspace(0, 1.5, 50)
        axis.plot(bound, (DEVICE_B + bound) / (T_S / 2 + delay * T_S), "k--", label="K = (b+B)/(T/2+dT)")
        axis.set_yscale("log")
        axis.set_ylim(18, 12000)
        axis.set_title(f"delay {delay} ms, controller {'on' if controller else 'off'}", fontsize=10)
        axis.grid(alpha=0.3)
        if delay == 0 or (controller and delay == 1):
            axis.set_ylabel("K, N/m")
        if controller or delay == 0:
            axis.set_xlabel("B, N s/m")
axes[0][0].legend(fontsize=8, loc="lower right")
figure.suptitle("45 g, b = 0.3 N s/m, nobody holds it, pushed by 0.5 N against a sampled wall", fontsize=11)
figure.tight_layout()
figure.savefig(picture, dpi=120)
