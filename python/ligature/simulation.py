"""The thread in its world, and what came of a script."""

import os
from collections.abc import Iterable
from typing import Any, Self

import numpy as np

from ligature import _core
from ligature.inputs import Script, knot, number, numbers

NOBODY = Script()


class Run:
    """What came of a script: a row a tick, shapes now and then. All arrays are read-only views of one run."""

    COLUMNS = ("t_s", "left_fx_N", "left_fy_N", "left_fz_N", "right_fx_N", "right_fy_N", "right_fz_N", "kinetic_J",
               "potential_J", "max_stretch", "min_gap_m", "contacts")

    def __init__(self, run: _core._Run) -> None:
        self.trace: np.ndarray = run.trace  # ticks x 12: COLUMNS, those of `ligature-lab run`'s trace.csv
        self.shape_t_s: np.ndarray = run.shape_t_s  # k, s: start, each shape_every_s, end
        self.shapes: np.ndarray = run.shapes  # k x nodes x 3, m
        self.finite: bool = run.finite  # False: it ended before its time, at a tick that is no number
        self.failure: str = run.failure  # "", or one line: tick, node, likely cause

    def __getitem__(self, column: str) -> np.ndarray:
        """One column of the trace by its name."""
        return self.trace[:, self.COLUMNS.index(column)]

    @property
    def t_s(self) -> np.ndarray:
        """ticks, s: time of the script at the end of each tick."""
        return self.trace[:, 0]

    @property
    def left_N(self) -> np.ndarray:
        """ticks x 3, N: force on the left hand, world newtons, before hands.force_scale and the limits of a device."""
        return self.trace[:, 1:4]

    @property
    def right_N(self) -> np.ndarray:
        """ticks x 3, N: the right hand's."""
        return self.trace[:, 4:7]

    def knot(self) -> _core.Knot:
        """The knot in the last shape."""
        return knot(self.shapes[-1])


class Simulation(_core.Simulation):
    """A thread in its world, stepped by the physics that the real-time firmware runs (firmware/physics/simulation.hpp).

    Results equal those of `ligature-lab` of the same build on the same kind of CPU to the last bit.
    """

    def run(self, script: _core.Script | None = None, duration_s: float | None = None, shape_every_s: float = 0.02,
            start_s: float = 0.0) -> Run:
        """Plays a script from its time start_s on, and goes on from there the next time.

        duration_s: None: to the script's end and nine seconds after, ten when there is none. shape_every_s: seconds
        between shapes. Other Python threads go on meanwhile, Ctrl-C ends it. Raises Refusal for times that are not
        allowed, or that would fill more than 4 GB.
        """
        return Run(self._run(NOBODY if script is None else script, *_times(duration_s, shape_every_s, start_s)))

    def rollout(self, scripts: Iterable[_core.Script], threads: int | None = None, duration_s: float | None = None,
                shape_every_s: float = 0.02, start_s: float = 0.0) -> list[Run]:
        """Each script on a copy of this simulation, which stays as it is; threads at once, None: as many as cores.

        As [self.copy().run(script, ..) for script in scripts], to the bit, whatever the number of threads.
        """
        count = len(os.sched_getaffinity(0)) if threads is None else threads
        runs = self._rollout(list(scripts), count, *_times(duration_s, shape_every_s, start_s))
        return [Run(run) for run in runs]

    def copy(self) -> Self:
        """A second simulation in the same state, which goes its own way."""
        return type(self)(self)

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> Self:
        return self.copy()

    def set_state(self, nodes: Any, velocities: Any = None) -> None:
        """Replaces shape and motion; hands open. nodes: n x 3, m; velocities: n x 3, m/s, None: at rest.

        Fixed nodes stay where they are. Raises Refusal for another shape, or for what is no number or beyond 1e9.
        """
        self._set_state(numbers(nodes, "nodes"), None if velocities is None else numbers(velocities, "velocities"))


def _times(duration_s: Any, shape_every_s: Any, start_s: Any) -> tuple[float | None, float, float]:
    duration = None if duration_s is None else number(duration_s, "duration_s")
    return duration, number(shape_every_s, "shape_every_s"), number(start_s, "start_s")
