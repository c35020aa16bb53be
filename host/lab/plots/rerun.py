"""Compares a rerun with its recording: forces on the hands, their difference, shapes.

Usage: rerun.py forces.csv shapes.csv rerun.png
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

forces, shapes, picture = sys.argv[1:]
tick = np.atleast_1d(np.genfromtxt(forces, delimiter=",", names=True))
shape = np.atleast_1d(np.genfromtxt(shapes, delimiter=",", names=True))
every = max(1, len(tick) // 20000)
tick = tick[::every]
figure, axes = plt.subplots(4, 1, sharex=True, figsize=(12, 9), dpi=130, height_ratios=[3, 3, 1.5, 1.5], layout="constrained")
for axis, hand in zip(axes, ("left", "right")):
    axis.plot(tick["t_s"], tick[f"{hand}_recorded_N"], color="#0072B2", linewidth=1.1, label="recorded")
    axis.plot(tick["t_s"], tick[f"{hand}_rerun_N"], color="#D55E00", linewidth=1.1, linestyle="--", label="rerun")
    axis.plot(tick["t_s"], tick[f"{hand}_apart_N"], color="#444444", linewidth=0.7, label="difference")
    axis.set_title(f"{hand} hand", loc="left", fontsize=10)
    axis.set_ylabel("force of the thread, N")
    axis.legend(loc="upper right", fontsize=8, frameon=False)
axes[2].plot(shape["t_s"], shape["rms_m"], color="#444444", linewidth=0.9, label="rms")
axes[2].plot(shape["t_s"], shape["largest_m"], color="#AAAAAA", linewidth=0.9, label="largest")
axes[2].set_ylabel("nodes apart, m")
axes[2].legend(loc="upper right", fontsize=8, frameon=False)
axes[3].plot(tick["t_s"], tick["time_lost_recorded"], color="#0072B2", linewidth=0.8)
axes[3].plot(tick["t_s"], tick["time_lost_rerun"], color="#D55E00", linewidth=0.8, linestyle="--")
axes[3].set_ylabel("time lost, share")
axes[3].set_xlabel("time since the run's start, s")
for axis in axes:
    axis.grid(True, color="#dddddd", linewidth=0.5)
figure.savefig(picture)
