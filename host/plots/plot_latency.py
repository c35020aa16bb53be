"""Draws the wake-up latencies of reports of `ligature-firmware doctor --report`: how many wake-ups were how late.

python3 plot_latency.py report.json [report.json ..] --out latency.png
Needs matplotlib. The picture appears under its name only when it is complete. Exit code 2: a file is no such report.
"""

import argparse
import json
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Okabe-Ito palette: distinguishable with the common forms of colour blindness and in grey.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
FORMAT = "ligature doctor 1"


class BadReport(Exception):
    """One line that names a file which cannot be drawn."""


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
    except OSError as error:
        raise BadReport(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError):  # no JSON
        report = None
    if not isinstance(report, dict) or report.get("format") != FORMAT:
        raise BadReport(f"{path}: found no report, allowed one of 'ligature-firmware doctor --report'")
    return report


def draw(axes, path, colour):
    report = read(path)
    try:
        if not report["wakeup"]["count"]:
            raise BadReport(f"{path}: no wake-up was measured; its verdict is '{report['verdict']}'")
        draw_report(axes, report, os.path.basename(path), colour)
    except (KeyError, TypeError, ValueError) as error:
        raise BadReport(f"{path}: found a damaged report ({error!r}), allowed a whole one") from error


def draw_report(axes, report, name, colour):
    wakeup = report["wakeup"]
    bins = wakeup["bins_us"]
    label = f"{name}: {report['machine']['kernel']}, {wakeup['count']} wake-ups, worst {wakeup['max_us']:.0f} us"
    axes.plot([us + 0.5 for us, _ in bins], [count for _, count in bins], ".", markersize=4, color=colour, label=label)
    if wakeup["over_10_ms"]:
        axes.plot([10_000], [wakeup["over_10_ms"]], "v", color=colour)
    if report["slack_us"] is not None:
        axes.axvline(report["slack_us"], color=colour, linestyle="--", label=f"what {report['scene']} leaves: {report['slack_us']:.0f} us")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reports", nargs="+")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    part = f"{arguments.out}.part-{os.getpid()}"
    try:
        figure, axes = plt.subplots(figsize=(9, 5), layout="constrained")
        for i, path in enumerate(arguments.reports):
            draw(axes, path, COLOURS[i % len(COLOURS)])
        axes.set(xscale="log", yscale="log", xlabel="wake-up latency, us", ylabel="wake-ups in a bin of 1 us", xlim=(0.5, 12_000))
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small")
        figure.savefig(part, format=os.path.splitext(arguments.out)[1][1:], dpi=150)
        os.replace(part, arguments.out)
    except BadReport as error:
        print(error, file=sys.stderr)
        return 2
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        if os.path.exists(part):
            os.remove(part)
    return 0


if __name__ == "__main__":
    sys.exit(main())
