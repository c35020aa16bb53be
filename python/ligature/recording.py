"""Recordings as arrays: LCM logs of `ligature-host record`, flight recorder and MCAP files; reruns."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ligature import _core
from ligature.inputs import Overrides, Path, Scene, lines_of, path_of
from ligature.mcap_file import reader_of

EVENT = np.dtype([("t_s", "f8"), ("tick", "i8"), ("kind", "i8"), ("hand", "i8"), ("code", "i8"), ("text", "O")])


class RecordedScene(NamedTuple):
    """A scene that was in force during a recording."""

    t_s: float  # time from which it was in force
    file: str
    toml: str  # text of the file; overrides and other settings follow as comments after a line "# as run:"

    def load(self, overrides: Overrides | None = None) -> Scene:
        """Loads the scene with the recorded overrides, and with further ones applied. Raises Refusal.

        If the scene takes its start shape from a file, that file must still exist and be unchanged.
        """
        return Scene(path_of(self.file), lines_of(overrides), self.toml, recorded=True)


class Shapes:
    """The k recorded shapes of the thread (60 Hz). Shapes may have different numbers of nodes."""

    def __init__(self, columns: dict[str, np.ndarray]) -> None:
        self.t_s: np.ndarray = columns["t_s"]  # k values, s
        self.tick: np.ndarray = columns["tick"]  # k values: number of the period of each shape
        self.radius_m: np.ndarray = columns["radius_m"]  # k values, m
        self._ends = np.cumsum(columns["count"])
        self._columns = columns

    def _part(self, name: str, i: int) -> np.ndarray:
        if name not in self._columns:
            raise _core.Refusal(f"shapes: found no {name}, as in MCAP files; allowed an LCM log")
        i = range(len(self))[i]  # negative numbers count from the end; IndexError out of range
        return self._columns[name][self._ends[i - 1] if i > 0 else 0:self._ends[i]]

    def __len__(self) -> int:
        return len(self.t_s)

    def __getitem__(self, i: int) -> np.ndarray:
        """Nodes of shape i: n x 3 float32, m."""
        return self._part("p_W_m", i)

    def __iter__(self) -> Iterator[np.ndarray]:
        return (self[i] for i in range(len(self)))

    def tension_N(self, i: int) -> np.ndarray:
        """n float32, N: tension of the edge after each node, positive for pull; the last repeats the one before."""
        return self._part("tension_N", i)

    def turn_rad(self, i: int) -> np.ndarray:
        """n float32, rad: rotation of the material frame against the frame carried without twist from node 0."""
        return self._part("turn_rad", i)

    def at(self, t_s: float) -> int:
        """Index of the shape nearest to time t_s."""
        if len(self) == 0:
            raise _core.Refusal("shapes: found none, allowed a recording with one")
        return int(np.argmin(np.abs(self.t_s - t_s)))


class Recording:
    """A whole recording in memory (about 1.1 kB a tick), read by the programs' readers (host/recording_reader.hpp).

    Each tick once, in order, as written by `ligature-host export`. Also reads an MCAP file that this program has written,
    with the extra `mcap`; such a file has no tension and no turn of its shapes, and NaN for infinite values. Raises
    Refusal when the file is none of these, or holds no tick.
    """

    def __init__(self, path: Path) -> None:
        self.path: str = path_of(path)  # the file
        self._take(reader_of(self.path)(self.path))

    def _take(self, recorded: Any) -> None:
        self.ticks: dict[str, np.ndarray] = recorded.ticks()  # columns of ticks.csv: t_s, session, tick, left_p_WT_x_m, ..
        self.shapes = Shapes(recorded.shapes())  # empty for a flight recorder file
        self.events: np.ndarray = np.array(recorded.events(), dtype=EVENT)  # t_s, tick, kind, hand, code, text
        self.scenes = [RecordedScene(*row) for row in recorded.scenes()]
        self.period_s: float = recorded.period_s  # control period of the loop, s
        self.max_force_N: float = recorded.max_force_N  # limit at the device
        self.firmware_version: str = recorded.firmware_version
        self.missing: int = recorded.missing  # ticks missing between the first and last of each session, summed
        self.damage: str = recorded.damage  # one line about damaged parts; "" for an intact file

    @property
    def t_s(self) -> np.ndarray:
        """Time of each tick since the firmware's start, s."""
        return self.ticks["t_s"]

    def vectors(self, quantity: str, unit: str) -> np.ndarray:
        """ticks x 3: the three columns of a vector, such as ("left_device_f", "N"), as one array (a copy)."""
        names = [f"{quantity}_{axis}_{unit}" for axis in "xyz"]
        if missing := [name for name in names if name not in self.ticks]:
            raise _core.Refusal(f"ticks: no column '{missing[0]}'; allowed those of ligature.TICK_COLUMNS")
        return np.stack([self.ticks[name] for name in names], axis=1)


class Rerun(Recording):
    """A recording whose thread has been computed again (`rerun`). Its arrays are those of the rerun.

    The tools are where they were; device forces are the recorded ones plus gain times force_scale times the difference
    of the thread's forces, at most hands.max_force_N.
    """

    def __init__(self, path: str, made: _core._Rerun) -> None:
        if not isinstance(made, _core._Rerun):
            raise TypeError(f"Rerun: found a {type(made).__name__}, allowed what ligature.rerun makes")
        self.path: str = path  # the recording that was computed again
        self._take(made.recorded)
        facts = made.facts()
        self.equal: bool = facts["equal"]  # every number of the thread is the recorded one, to the bit
        self.first_difference: str = facts["first_difference"]  # "" or tick, column and both values
        self.unknown_ticks: int = facts["unknown_ticks"]  # not computed: a hole before them; their values are the recorded ones
        self.left_peak_N: float = facts["left_peak_N"]  # largest force of the thread on the left hand
        self.right_peak_N: float = facts["right_peak_N"]  # on the right hand
        self.left_apart_rms_N: float = facts["left_apart_rms_N"]  # root mean square of the difference from the recorded force
        self.right_apart_rms_N: float = facts["right_apart_rms_N"]  # on the right hand
        self.lost_ticks: float = facts["lost_ticks"]  # time in which the thread was not moved, in ticks
        self.knots: list[tuple[float, str]] = facts["knots"]  # time in s and type, one entry per change; looked at every 0.1 s
        self.tick_us: np.ndarray = made.cost_us()  # CPU time of the thread's ticks, us


def rerun(recording: Recording | Path, overrides: Overrides | None = None, session: int | None = None,
          cuts: bool | None = None) -> Rerun:
    """Computes the thread of a recorded run again, with the recorded motion of the tools: `ligature-lab rerun`.

    recording: an LCM log, or a Recording of one. overrides: of every recorded scene. session: number from 1; None: the
    only one. cuts: whether a tick ends early where it ran out of time in the recording; None: only without overrides.
    Other Python threads run meanwhile; Ctrl-C stops. Raises Refusal for a recording that lacks something, or settings
    that are not allowed. Source: host/lab/rerun/rerun.hpp.
    """
    path = recording.path if isinstance(recording, Recording) else path_of(recording)
    lines = lines_of(overrides)
    return Rerun(path, _core._rerun(path, lines, not lines if cuts is None else bool(cuts), 0 if session is None else session))


TICK_COLUMNS: dict[str, tuple[str, str]] = _core._tick_meanings()  # name: (unit, meaning)
