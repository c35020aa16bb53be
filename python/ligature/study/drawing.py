"""Pictures of the tables of a study, by matplotlib."""

import math
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from ligature.study.tables import Rows, groups, text  # noqa: E402

# Okabe-Ito palette: distinguishable with the common forms of colour blindness.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#882255", "#111111")
MARKS = "os^Dv<>P"


def _title(names: list[str], group: tuple[Any, ...]) -> str:
    return ", ".join(text(value) if isinstance(value, str) else f"{name} = {text(value)}" for name, value in zip(names, group))


def _sheet(lines: Rows, names: list[str], width: float, height: float) -> tuple[Any, list[tuple[Any, Rows]]]:
    """A figure with one panel for each group of lines."""
    panels = list(groups(lines, names))
    last = len({group[-1] for group, _ in panels if group})
    columns = last if len(names) > 1 and last <= 6 else min(len(panels), 4)
    figure, axes = plt.subplots(math.ceil(len(panels) / columns), columns, squeeze=False, layout="constrained",
                                figsize=(width * columns, height * math.ceil(len(panels) / columns)))
    for spare in axes.flat[len(panels):]:
        spare.axis("off")
    for axis, (group, _) in zip(axes.flat, panels):
        axis.set_title(_title(names, group), fontsize=10)
    return figure, [(axis, members) for axis, (_, members) in zip(axes.flat, panels)]


def _map(plot: dict[str, Any], lines: Rows) -> Any:
    x, y = (sorted({line[plot[key]] for line in lines}) for key in "xy")
    values = [line["value"] for line in lines if not math.isnan(line["value"])]
    share = any(line["yes"] is not None for line in lines)
    low, high = (0.0, 1.0) if share or not values else (min(values), max(values))
    figure, panels = _sheet(lines, plot["panels"], 1.3 + 0.34 * len(x), 1.3 + 0.34 * len(y))
    for axis, members in panels:
        cells = [[math.nan] * len(x) for _ in y]
        for line in members:
            cells[y.index(line[plot["y"]])][x.index(line[plot["x"]])] = line["value"]
        image = axis.imshow(cells, origin="lower", aspect="auto", cmap="cividis", vmin=low, vmax=high)
        for line in members:
            shown = f"{100 * line['value']:.0f}" if share else f"{line['value']:.3g}"
            bright = line["value"] > 0.5 * (low + high)
            axis.text(x.index(line[plot["x"]]), y.index(line[plot["y"]]), shown, ha="center", va="center", fontsize=7,
                      color="black" if bright else "white")
        axis.set_xticks(range(len(x)), [text(value) for value in x], fontsize=8, rotation=45)
        axis.set_yticks(range(len(y)), [text(value) for value in y], fontsize=8)
        axis.set(xlabel=plot["x"], ylabel=plot["y"])
    figure.colorbar(image, ax=[axis for axis, _ in panels], label=f"share with {plot['measure']}; cells: %" if share else plot["measure"])
    return figure


def _curves(plot: dict[str, Any], lines: Rows, x: str, y: str, low: str, high: str, joined: bool) -> Any:
    figure, panels = _sheet(lines, plot.get("panels", []), 5.2, 4.2)
    for axis, members in panels:
        for number, (group, line) in enumerate(groups(members, plot["lines"])):
            known = [point for point in line if not math.isnan(point[y])]
            at = [point[x] if x else 0 for point in known]
            reach = [[max(0.0, point[y] - point[low]) if not math.isnan(point[low]) else 0.0 for point in known],
                     [max(0.0, point[high] - point[y]) if not math.isnan(point[high]) else 0.0 for point in known]]
            axis.errorbar(at, [point[y] for point in known], yerr=reach, capsize=3, markersize=5, linewidth=1,
                          linestyle="-" if joined else "none", marker=MARKS[number % len(MARKS)],
                          color=COLOURS[number % len(COLOURS)], label=_title(plot["lines"], group) or None)
            if not joined:
                front = sorted((point[x], point[y]) for point in line if point["front"])
                axis.step(*zip(*front), where="post", color=COLOURS[number % len(COLOURS)], linewidth=1) if front else None
        axis.set_xlabel(x)
        if x in plot["log"]:
            axis.set_xscale("log")
        if plot.get("over", y) in plot["log"]:
            axis.set_yscale("log")
        axis.grid(color="#DDDDDD", linewidth=0.5)
        if plot["lines"]:
            axis.legend(fontsize=8, frameon=False)
    return figure, panels


def _threshold(plot: dict[str, Any], lines: Rows) -> Any:
    figure, panels = _curves(plot, lines, plot["x"], "at", "low", "high", joined=True)
    for axis, _ in panels:
        axis.set_ylabel(f"{plot['over']} at which half of the runs have {plot['measure']}")
        axis.yaxis.label.set_size(9)
    return figure


def _front(plot: dict[str, Any], lines: Rows) -> Any:
    figure, panels = _curves(plot, lines, plot["cost"], plot["error"], f"{plot['error']} low", f"{plot['error']} high", joined=False)
    for axis, _ in panels:
        axis.set_ylabel(plot["error"])
    return figure


def save(plot: dict[str, Any], lines: Rows, path: str) -> None:
    """Draws one plot."""
    figure = {"map": _map, "threshold": _threshold, "front": _front}[plot["kind"]](plot, lines)
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)
