"""The plots of a study: entries [[plot]] of its file, and their tables and pictures."""

import os
from typing import TYPE_CHECKING, Any

from ligature._core import Refusal
from ligature.study import tables
from ligature.study.values import Place, Text, no_others, table

if TYPE_CHECKING:
    from ligature.study.definition import Study

# kind: (keys with one column, keys with one column or none, keys with a list of columns)
KINDS: dict[str, tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]] = {
    "map": (("x", "y", "measure"), (), ("panels",)),
    "threshold": (("over", "measure"), ("x",), ("panels", "lines")),
    "front": (("cost", "error"), (), ("lines", "label")),
}
TABLES = {"map": tables.map_of, "threshold": tables.thresholds_of, "front": tables.fronts_of}


def _one(place: Place, entry: Any, number: int, columns: list[str] | None) -> dict[str, Any]:
    entry = table(place, entry)
    kind = Text(tuple(KINDS)).check(place.of("kind"), entry.get("kind"))
    needed, possible, lists = KINDS[kind]
    no_others(place, entry, ("kind", "name", "log", *needed, *possible, *lists))
    column = Text(tuple(columns or ()))
    plot: dict[str, Any] = {"kind": kind, "name": Text().check(place.of("name"), entry.get("name", f"{kind}-{number}")),
                            "log": entry.get("log", [])}
    if os.path.basename(plot["name"]) != plot["name"]:
        raise place.of("name").refuse(plot["name"], "a file name without folder")
    for key in needed:
        plot[key] = column.check(place.of(key), entry.get(key))
    for key in possible:
        plot[key] = column.check(place.of(key), entry[key]) if key in entry else ""
    for key in (*lists, "log"):
        value = entry.get(key, [])
        if not isinstance(value, list):
            raise place.of(key).refuse(value, "a list of columns")
        plot[key] = [column.check(place.of(key), each) for each in value]
    return plot


def read(place: Place, entries: Any, columns: list[str] | None) -> list[dict[str, Any]]:
    """Reads the entries [[plot]]. columns: what a row has; None: not known. Raises Refusal."""
    if not isinstance(entries, list):
        raise place.refuse(entries, "tables [[plot]]")
    plots = [_one(place, entry, number + 1, columns) for number, entry in enumerate(entries)]
    names = [plot["name"] for plot in plots]
    if len(set(names)) < len(names):
        raise place.of("name").refuse(max(names, key=names.count), "a name for each plot")
    return plots


def draw(study: "Study", out: str) -> list[str]:
    """See Study.plot."""
    if not study.plots:
        raise Refusal(f"{study.file}: key 'plot': found no table, allowed [[plot]] with a kind of {', '.join(KINDS)}")
    from ligature.study import store
    from ligature.study.drawing import save

    found = store.rows(out).to_pylist()
    made = [(plot, TABLES[plot["kind"]](found, plot)) for plot in study.plots]
    paths = []
    for plot, lines in made:
        if not lines:
            raise Refusal(f"{out}: plot '{plot['name']}': found no row to draw, allowed some")
        paths += [os.path.join(out, f"{plot['name']}.{ending}") for ending in ("csv", "png")]
        tables.write_csv(paths[-2], lines)
        save(plot, lines, paths[-1])
    return paths
