"""Recordings: LCM logs of `ligature-host record` and files of the flight recorder, as arrays."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ligature import _core
from ligature.inputs import Overrides, Path, Scene, lines_of, path_of

EVENT = np.dtype([("t_s", "f8"), ("tick", "i8"), ("kind", "i8"), ("hand", "i8"), ("code", "i8"), ("text", "O")])


class RecordedScene(NamedTuple):
    """A scene as the recording tells it."""

    t_s: float  # from when on it was in force
    file: str
    toml: str  # the file's text; overrides and the like as comments behind a line "# as run:"

    def load(self, overrides: Overrides | None = None) -> Scene:
        """The scene again, recorded overrides included, and others on top. Raises Refusal.

        A shape from a file of its own must be where it was, and be the same.
        """
        return Scene(path_of(self.file), lines_of(overrides), self.toml, recorded=True)


class Shapes:
    """The thread now and then (60 Hz), each shape with as many nodes as it had."""

    def __init__(self, columns: dict[str, np.ndarray]) -> None:
        self.t_s: np.ndarray = columns["t_s"]  # k, s
        self.tick: np.ndarray = columns["tick"]  # k: period whose shape it is
        self.radius_m: np.ndarray = columns["radius_m"]  # k, m
        self._ends = np.cumsum(columns["count"])
        self._columns = columns

    def _part(self, name: str, i: int) -> np.ndarray:
        i = range(len(self))[i]  # negative ones from the end, IndexError beyond
        return self._columns[name][self._ends[i - 1] if i > 0 else 0:self._ends[i]]

    def __len__(self) -> int:
        return len(self.t_s)

    def __getitem__(self, i: int) -> np.ndarray:
        """Nodes of shape i: n x 3 float32, m."""
        return self._part("p_W_m", i)

    def __iter__(self) -> Iterator[np.ndarray]:
        return (self[i] for i in range(len(self)))

    def tension_N(self, i: int) -> np.ndarray:
        """n float32, N: of the edge after each node, positive pulls; the last repeats the one before."""
        return self._part("tension_N", i)

    def turn_rad(self, i: int) -> np.ndarray:
        """n float32, rad: material frame against the one carried along without twist from node 0."""
        return self._part("turn_rad", i)

    def at(self, t_s: float) -> int:
        """Number of the shape nearest to a time, s."""
        if len(self) == 0:
            raise _core.Refusal("shapes: found none, allowed a recording with one")
        return int(np.argmin(np.abs(self.t_s - t_s)))


class Recording:
    """A whole recording in memory (about 1.1 kB a tick), read by the programs' own readers (host/recording_reader.hpp).

    Each tick once, in order, as `ligature-host export` writes it. Raises Refusal for a file that is neither an LCM log
    nor of a flight recorder, or holds no tick.
    """

    def __init__(self, path: Path) -> None:
        recorded = _core._read_recording(path_of(path))
        self.ticks: dict[str, np.ndarray] = recorded.ticks()  # columns of ticks.csv: t_s, session, tick, left_p_WT_x_m, ..
        self.shapes = Shapes(recorded.shapes())  # none of a flight recorder
        self.events: np.ndarray = np.array(recorded.events(), dtype=EVENT)  # t_s, tick, kind, hand, code, text
        self.scenes = [RecordedScene(*row) for row in recorded.scenes()]
        self.period_s: float = recorded.period_s  # of the loop
        self.max_force_N: float = recorded.max_force_N  # limit at the device
        self.firmware_version: str = recorded.firmware_version
        self.missing: int = recorded.missing  # ticks between the first and the last of a run that are not there
        self.damage: str = recorded.damage  # one line; "" for a sound file

    @property
    def t_s(self) -> np.ndarray:
        """Time of each tick since the firmware's start, s."""
        return self.ticks["t_s"]

    def vectors(self, quantity: str, unit: str) -> np.ndarray:
        """ticks x 3 of "left_device_f", "N": the three columns of a vector as one array (a copy)."""
        names = [f"{quantity}_{axis}_{unit}" for axis in "xyz"]
        if missing := [name for name in names if name not in self.ticks]:
            raise _core.Refusal(f"ticks: no column '{missing[0]}'; allowed those of ligature.TICK_COLUMNS")
        return np.stack([self.ticks[name] for name in names], axis=1)


TICK_COLUMNS: dict[str, tuple[str, str]] = _core._tick_meanings()  # name: (unit, meaning)
