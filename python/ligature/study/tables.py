"""Tables of a study's rows: a map over two parameters, thresholds along one, and fronts of two measures."""

import csv
import math
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from ligature._core import Refusal
from ligature.study import statistics

Rows = list[dict[str, Any]]


def _cell(row: dict[str, Any], name: str) -> Any:
    if name not in row:
        raise Refusal(f"plot: column '{name}': found none of this name, allowed one of {', '.join(sorted(row))}")
    return row[name]


def groups(found: Rows, keys: list[str]) -> Iterator[tuple[tuple[Any, ...], Rows]]:
    """Rows with equal values of the keys, in the order of these values."""
    together: dict[tuple[Any, ...], Rows] = {}
    for row in found:
        together.setdefault(tuple(_cell(row, key) for key in keys), []).append(row)
    yield from sorted(together.items(), key=lambda item: [(isinstance(value, str), value) for value in item[0]])


def _value(row: dict[str, Any], name: str) -> Any:
    value = _cell(row, name)
    if not isinstance(value, (bool, int, float)):
        raise Refusal(f"plot: column '{name}' of run {row['run']}: found {value!r}, allowed a number or a truth value")
    return value


def summary(found: Rows, measure: str) -> dict[str, Any]:
    """Share or mean of a measure with its 95 % interval; the runs that failed are counted."""
    done = [row for row in found if row["status"] == "done"]
    values = [_value(row, measure) for row in done]
    cells: dict[str, Any] = {"runs": len(done), "failed": len(found) - len(done)}
    if values and all(isinstance(value, bool) for value in values):
        low, high = statistics.wilson(sum(values), len(values))
        return cells | {"yes": sum(values), "value": sum(values) / len(values), "low": low, "high": high}
    middle, low, high = statistics.mean(np.array(values, dtype=float))
    return cells | {"yes": None, "value": middle, "low": low, "high": high}


def map_of(found: Rows, plot: dict[str, Any]) -> Rows:
    """One line for each pair of x and y, in each panel: share or mean, with its interval."""
    keys = [*plot["panels"], plot["x"], plot["y"]]
    return [dict(zip(keys, group)) | summary(members, plot["measure"]) for group, members in groups(found, keys)]


def thresholds_of(found: Rows, plot: dict[str, Any]) -> Rows:
    """One line for each value of x, in each panel and for each line: the threshold of the measure along `over`."""
    keys = [*plot["panels"], *plot["lines"], *([plot["x"]] if plot["x"] else [])]
    lines = []
    for group, members in groups(found, keys):
        done = [row for row in members if row["status"] == "done"]
        at = statistics.threshold([_value(row, plot["over"]) for row in done], [_value(row, plot["measure"]) for row in done])
        lines.append(dict(zip(keys, group)) | {"runs": len(done), "failed": len(members) - len(done), **at._asdict()})
    return lines


def fronts_of(found: Rows, plot: dict[str, Any]) -> Rows:
    """One line for each setting of the parameters: means of both measures; on the front if no other is better in both."""
    cost, error, keys = plot["cost"], plot["error"], [*plot["lines"], *plot["label"]]
    lines = []
    for group, members in groups(found, list(dict.fromkeys(keys))):
        middles = [summary(members, name) for name in (cost, error)]
        lines.append(dict(zip(dict.fromkeys(keys), group)) | {"runs": middles[0]["runs"], cost: middles[0]["value"],
                     f"{cost} low": middles[0]["low"], f"{cost} high": middles[0]["high"], error: middles[1]["value"],
                     f"{error} low": middles[1]["low"], f"{error} high": middles[1]["high"]})
    for _, rivals in groups(lines, plot["lines"]):
        for line in rivals:
            line["front"] = not math.isnan(line[cost] + line[error]) and not any(
                other[cost] <= line[cost] and other[error] <= line[error] and (other[cost], other[error]) != (line[cost], line[error])
                for other in rivals)
    return lines


def text(value: Any) -> str:
    """A cell: six digits, empty for what is not known, file names without folder and ending."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, float):
        return f"{value:.6g}"
    return os.path.splitext(os.path.basename(value))[0] if isinstance(value, str) and value.endswith((".toml", ".csv")) else str(value)


def write_csv(path: str, lines: Rows) -> None:
    """Writes lines with equal keys as CSV."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(lines[0])
        writer.writerows([text(value) for value in line.values()] for line in lines)
