"""Draws forces.csv of `ligature-host export`: force on each hand against time.

python3 plot_forces.py forces.csv --out forces.png [--title TEXT] [--limit N]
Needs numpy and matplotlib. The picture appears under its name only when it is complete.
"""

import argparse
import json
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Okabe-Ito palette: distinguishable with the common forms of colour blindness and in grey.
HANDS = {"left": "#0072B2", "right": "#D55E00"}
LIMIT = "#000000"
STATES = {0: ("OFF", "#999999"), 1: ("CALIBRATE", "#56B4E9"), 2: ("IDLE", "#DDDDDD"), 3: ("ENGAGE", "#F0E442"),
          4: ("FORCE", "#009E73"), 5: ("BRAKE", "#CC79A7"), 6: ("FAULT", "#882255")}
LABEL = 0.05  # width of a node's label, as a share of the time axis
POINTS = 6000  # largest number of points drawn per curve, a few per pixel column


def read(path):
    """The table's columns by name, in order of time; each session's time continues after the one before."""
    with open(path, encoding="ascii") as file:
        names = file.readline().strip().split(",")
        table = np.loadtxt(file, delimiter=",", ndmin=2)
    column = {name: table[:, i] for i, name in enumerate(names)}
    time, offset = column["t_s"].copy(), 0.0
    for session in np.unique(column["session"]):
        rows = column["session"] == session
        time[rows] += offset - time[rows].min() if session > 1 else 0.0
        offset = time[rows].max()
    order = np.argsort(time, kind="stable")
    return {name: values[order] for name, values in column.items()}, time[order]


def thinned(time, values):
    """At most about POINTS points of a curve: divides its samples into bins of equal size, and keeps the smallest and
    the largest value of each, so that no spike is lost.
    """
    bins = len(values) // (POINTS // 2)
    if bins < 2:
        return time, values
    whole = len(values) // bins * bins
    blocks = values[:whole].reshape(-1, bins)
    start = np.arange(0, whole, bins)
    pick = np.sort(np.stack([start + blocks.argmin(1), start + blocks.argmax(1)], 1), axis=1).ravel()
    pick = np.concatenate([pick, np.arange(whole, len(values))])
    return time[pick], values[pick]


def spans(values):
    """(first row, row after the last, value) of every run of equal values."""
    edges = np.flatnonzero(np.diff(values)) + 1
    starts = np.concatenate([[0], edges])
    ends = np.concatenate([edges, [len(values)]])
    return [(a, b, values[a]) for a, b in zip(starts, ends)]


def mark_losses(axes, time):
    """Hatches the times of samples that were not recorded: a line drawn across such a gap is no data."""
    steps = np.diff(time)
    holes = np.flatnonzero(steps > 1.5 * np.median(steps)) if len(steps) else []
    for i, hole in enumerate(holes):
        axes.axvspan(time[hole], time[hole + 1], facecolor="none", edgecolor="#555555", hatch="////", linewidth=0,
                     zorder=4, label="samples lost" if i == 0 else None)


def embedded(path):
    """Scene and versions from the table's metadata file, to be stored in the picture's metadata."""
    try:
        with open(path + "-metadata.json", encoding="utf-8") as file:
            facts = json.load(file)
    except OSError:
        return {}
    keys = ("dc:source", "ligature:host_version", "ligature:firmware_version", "ligature:scene_file", "ligature:scene_toml")
    return {"Description": "\n".join(f"{key.split(':')[1]}: {facts.get(key, '')}" for key in keys)}


def save(figure, out, metadata):
    part = f"{out}.part-{os.getpid()}"
    kind = os.path.splitext(out)[1].lstrip(".").lower() or "png"
    if kind == "pdf":
        metadata = {"Subject": text for text in metadata.values()}
    try:
        figure.savefig(part, format=kind, metadata=metadata)
        os.replace(part, out)
    finally:
        if os.path.exists(part):
            os.remove(part)


def top_N(peaks_N, limit_N):
    """Upper end of the force axis, the same for both hands: with the limit when a force comes near it, else by the
    largest force.
    """
    largest_N = max(peaks_N)
    return max(1.12 * limit_N, 1.05 * largest_N) if largest_N > 0.5 * limit_N else max(1.15 * largest_N, 1e-3 * limit_N)


def apart(times, least):
    """Those of the rising times that are at least `least` after the one before, so that their labels do not overlap."""
    kept = []
    for time in times:
        if not kept or time - kept[-1] >= least:
            kept.append(time)
    return kept


def draw_hand(axes, column, time, hand, limit_N, top, frames):
    colour = HANDS[hand]
    force_N = column[f"{hand}_device_f_N"]
    node = column[f"{hand}_node"]
    axes.plot(*thinned(time, force_N), color=colour, linewidth=1.1, label="|F| commanded to the device")
    above = ", above the axis" if limit_N > top else ""
    axes.axhline(limit_N, color=LIMIT, linestyle="--", linewidth=1.0, label=f"limit {limit_N:g} N{above}")
    marks, nodes = {"grasp": [], "release": []}, {}
    for first, after, held in spans(node >= 0):  # not by equal node number, which remeshing changes
        if not held:
            continue
        axes.axvspan(time[first], time[after - 1], color=colour, alpha=0.08, linewidth=0)
        if first > 0:
            marks["grasp"].append(time[first])
        if after < len(time):
            marks["release"].append(time[after])
        nodes[time[first]] = int(node[first])
    for at in apart(nodes, LABEL * (time[-1] - time[0])):
        axes.annotate(f"node {nodes[at]}", (at, 1.0), xycoords=("data", "axes fraction"), xytext=(3, -11),
                      textcoords="offset points", fontsize=7, color=colour)
    mark_losses(axes, time)
    for name, marker in (("grasp", "^"), ("release", "v")):
        if not marks[name]:
            continue  # markers without a place leave the axes no room in the picture
        axes.vlines(marks[name], 0, top, color=colour, linewidth=0.6, linestyle=":")
        axes.plot(marks[name], np.zeros(len(marks[name])), marker, color=colour, markeredgecolor="black", markersize=7,
                  clip_on=False, linestyle="none", label=name, zorder=5)
    peak = int(force_N.argmax())
    held = node >= 0
    mean = f", mean while holding {force_N[held].mean():.2f} N" if held.any() else ""
    axes.set_title(f"{hand} hand: peak {force_N[peak]:.2f} N at {time[peak]:.{0 if frames else 2}f}{'' if frames else ' s'}{mean}", loc="left", fontsize=10)
    axes.set_ylim(0, top)
    axes.set_ylabel("force magnitude, N")
    axes.grid(True, color="#dddddd", linewidth=0.5)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8, frameon=False)


def draw_states(axes, column, time, frames):
    for first, after, state in spans(column["state"]):
        name, colour = STATES.get(int(state), (f"state {int(state)}", "white"))
        end = time[after] if after < len(time) else time[-1]
        axes.axvspan(time[first], end, color=colour, linewidth=0)
        if end - time[first] > 0.05 * (time[-1] - time[0]):
            axes.text((time[first] + end) / 2, 0.5, name, ha="center", va="center", fontsize=8,
                      transform=axes.get_xaxis_transform(),
                      color="white" if name in ("FORCE", "FAULT") else "black")
    seen = sorted({int(s) for s in column["state"]})
    patches = [plt.Rectangle((0, 0), 1, 1, color=STATES[s][1], label=STATES[s][0]) for s in seen if s in STATES]
    axes.legend(handles=patches, loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=7, frameon=False,
                ncols=2 if len(patches) > 3 else 1)
    axes.set_yticks([])
    axes.set_ylabel("state", rotation=0, ha="right", va="center")
    axes.set_xlabel("haptic frame" if frames else "time since the firmware's start, s")


def draw(path, out, title, limit_N, frames):
    column, time = read(path)
    if frames:
        time = column["tick"]
    figure, axes = plt.subplots(3, 1, sharex=True, figsize=(12, 7), dpi=130, height_ratios=[6, 6, 0.8],
                                layout="constrained")
    top = top_N([column[f"{hand}_device_f_N"].max() for hand in HANDS], limit_N)
    for axis, hand in zip(axes, HANDS):
        draw_hand(axis, column, time, hand, limit_N, top, frames)
    draw_states(axes[2], column, time, frames)
    axes[2].set_xlim(time[0], max(time[-1], time[0] + 1e-3))
    figure.suptitle(f"Force on each hand, {title}: {len(time)} ticks")
    save(figure, out, embedded(path))


def drawn(draw, *arguments):
    """Runs draw(*arguments). @return exit code 0; 1 with one line on stderr when a file or its numbers are invalid."""
    try:
        draw(*arguments)
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("forces")
    parser.add_argument("--out", required=True)
    parser.add_argument("--title", default="recording")
    parser.add_argument("--limit", type=float, default=3.3, help="force limit of the device, N")
    parser.add_argument("--frames", action="store_true", help="against the number of the haptic frame, as the paper's Table III")
    arguments = parser.parse_args()
    return drawn(draw, arguments.forces, arguments.out, arguments.title, arguments.limit, arguments.frames)


if __name__ == "__main__":
    sys.exit(main())
