"""Which runs a study has: every combination of its lists and ranges, with each point of its Latin hypercube and each seed."""

import itertools
import math
import random
from typing import Any, NamedTuple

from ligature.study.values import Flag, Number, Place, no_others, table

MOST_RUNS = 1_000_000


class Axis(NamedTuple):
    """One parameter: its values, or the interval of a Latin hypercube."""

    name: str
    values: list[Any]  # of a Latin parameter: low and high
    latin: bool = False
    log: bool = False


def _interval(place: Place, low: Any, high: Any, log: bool) -> tuple[float, float]:
    low, high = Number().check(place, low), Number().check(place, high)
    if not low < high or (log and low <= 0):
        raise place.refuse([low, high], "a smaller and a larger number" + (", both above 0" if log else ""))
    return low, high


def _between(low: float, high: float, share: float, log: bool) -> float:
    return low * (high / low) ** share if log else low + (high - low) * share


def _tidy(value: float) -> float:
    """Without the rounding of sums: 0.1 + 2 * 0.1 is 0.3."""
    return float(f"{value:.12g}")


def _range(place: Place, entry: dict[str, Any], log: bool) -> list[float]:
    low, high = _interval(place, entry["from"], entry.get("to"), log)
    if ("step" in entry) == ("count" in entry) or ("step" in entry and log):
        raise place.refuse("no clear spacing", "either 'step' or 'count'; with 'log' only 'count'")
    if "count" in entry:
        count = Number(2, MOST_RUNS, whole=True).check(place.of("count"), entry["count"])
        return [_tidy(_between(low, high, i / (count - 1), log)) for i in range(count)]
    step = Number(1e-300, high - low).check(place.of("step"), entry["step"])
    if (high - low) / step > MOST_RUNS:
        raise place.of("step").refuse(step, f"at most {MOST_RUNS} values")
    return [_tidy(low + i * step) for i in range(math.floor((high - low) / step * (1 + 1e-9)) + 1)]


def axis(place: Place, name: str, entry: Any) -> Axis:
    """Reads one entry of [parameters]. Raises Refusal."""
    if isinstance(entry, list):
        if not entry or any(isinstance(value, dict) for value in entry):
            raise place.refuse(entry, "a list of values")
        if len({repr(value) for value in entry}) < len(entry):
            raise place.refuse(entry, "different values")
        return Axis(name, entry)
    entry = table(place, entry) if isinstance(entry, dict) else {"": entry}
    log = Flag().check(place.of("log"), entry.get("log", False))
    if "latin" in entry:
        no_others(place, entry, ("latin", "log"))
        ends = entry["latin"]
        if not isinstance(ends, list) or len(ends) != 2:
            raise place.of("latin").refuse(ends, "[low, high]")
        return Axis(name, list(_interval(place.of("latin"), *ends, log)), latin=True, log=log)
    if "from" not in entry:
        raise place.refuse(entry.get("", entry), "a list, {from, to, step}, {from, to, count, log} or {latin = [low, high], log}")
    no_others(place, entry, ("from", "to", "step", "count", "log"))
    return Axis(name, _range(place, entry, log))


def latin_points(axes: list[Axis], points: int, seed: int) -> list[tuple[float, ...]]:
    """A Latin hypercube: in each axis, exactly one of the `points` lies in each of as many equal parts."""
    random_ = random.Random(seed)
    columns = []
    for each in axes:
        parts = list(range(points))
        random_.shuffle(parts)
        columns.append([_between(*each.values, (part + random_.random()) / points, each.log) for part in parts])
    return list(zip(*columns, strict=True))


class Design:
    """All runs in a fixed order; run i is computed when it is asked for."""

    def __init__(self, axes: list[Axis], seeds: list[int], points: int, latin_seed: int) -> None:
        self.axes = axes
        self.seeds = seeds
        self._grid = [each for each in axes if not each.latin]
        self._latin = [each for each in axes if each.latin]
        self._drawn = latin_points(self._latin, points, latin_seed) if self._latin else [()]
        self._sizes = [*(len(each.values) for each in self._grid), len(self._drawn), len(seeds)]
        self.size: int = math.prod(self._sizes)  # may be too large for len()

    def __len__(self) -> int:
        return self.size

    def __getitem__(self, run: int) -> tuple[dict[str, Any], int]:
        """Parameters and seed of a run; the seed changes fastest."""
        run = range(len(self))[run]  # IndexError out of range, which ends a loop over the design
        places = []
        for size in reversed(self._sizes):
            run, place = divmod(run, size)
            places.append(place)
        *grid, point, seed = reversed(places)
        chosen = {each.name: each.values[at] for each, at in zip(self._grid, grid)}
        chosen.update(zip((each.name for each in self._latin), self._drawn[point]))
        return {each.name: chosen[each.name] for each in self.axes}, self.seeds[seed]

    def samples(self) -> list[dict[str, Any]]:
        """Parameters in which every value, and both ends of every Latin interval, stands at least once."""
        first = {each.name: each.values[0] for each in self.axes}
        others = [first | {each.name: value} for each in self.axes for value in each.values[1:]]
        return list(itertools.chain([first], others))
