"""The simulated thread, and the results of a script."""

import os
import threading
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np

from ligature import _core
from ligature.inputs import Script, knot, number, numbers

NOBODY = Script()


class Run:
    """Results of a script: one row per tick, and shapes at intervals. All arrays are read-only views of one run."""

    COLUMNS = ("t_s", "left_fx_N", "left_fy_N", "left_fz_N", "right_fx_N", "right_fy_N", "right_fz_N", "kinetic_J",
               "potential_J", "max_stretch", "min_gap_m", "contacts")

    def __init__(self, run: _core._Run) -> None:
        if not isinstance(run, _core._Run):
            raise TypeError(f"Run: found a {type(run).__name__}, allowed what Simulation.run and rollout make")
        self.trace: np.ndarray = run.trace  # ticks x 12: COLUMNS, as in trace.csv of `ligature-lab run`
        self.shape_t_s: np.ndarray = run.shape_t_s  # k times, s: at the start, every shape_every_s, at the end
        self.shapes: np.ndarray = run.shapes  # k x nodes x 3, m
        self.finite: bool = run.finite  # False: stopped early, at a tick with a non-finite state
        self.failure: str = run.failure  # "" or one line: tick, node, likely cause

    def __getitem__(self, column: str) -> np.ndarray:
        """One column of the trace by its name."""
        return self.trace[:, self.COLUMNS.index(column)]

    @property
    def t_s(self) -> np.ndarray:
        """ticks, s: time of the script at the end of each tick."""
        return self.trace[:, 0]

    @property
    def left_N(self) -> np.ndarray:
        """ticks x 3, N: force of the thread on the left hand, in world axes; not yet scaled by force_scale or limited."""
        return self.trace[:, 1:4]

    @property
    def right_N(self) -> np.ndarray:
        """ticks x 3, N: force on the right hand, as left_N."""
        return self.trace[:, 4:7]

    def knot(self) -> _core.Knot:
        """The knot in the last shape."""
        return knot(self.shapes[-1])


class Contacts(NamedTuple):
    """The k places where the thread touched itself, the desk or a body with a force, in the last time step of a tick.

    Segment i lies between the nodes i and i + 1. A contact of two strands appears once.
    """

    pairs: np.ndarray  # k x 2: segment, and the other strand's segment; -1: the desk, a peg, a gripper or a hook
    points_m: np.ndarray  # k x 3, m: between the two surfaces
    normals: np.ndarray  # k x 3: unit vectors from the other towards the segment
    forces_N: np.ndarray  # k x 3, N: on the segment, friction included; the other gets the opposite
    gaps_m: np.ndarray  # k, m: distance of the surfaces before the step; negative: overlap


class Simulation(_core.Simulation):
    """A thread in its world, simulated by the firmware's physics (firmware/physics/simulation.hpp).

    Results are bit-identical to those of `ligature-lab` of the same build on the same kind of CPU.
    """

    def run(self, script: _core.Script | None = None, duration_s: float | None = None, shape_every_s: float = 0.02,
            start_s: float = 0.0) -> Run:
        """Plays a script from its time start_s; a further call continues with the thread as it is then.

        duration_s: None: to the script's end and nine seconds more; ten seconds without a script. shape_every_s:
        seconds between shapes. Other Python threads keep running meanwhile; Ctrl-C stops the run. Raises Refusal for
        invalid times, and for a run that would need more than 4 GB.
        """
        return Run(self._run(NOBODY if script is None else script, *_times(duration_s, shape_every_s, start_s)))

    def rollout(self, scripts: Iterable[_core.Script], threads: int | None = None, duration_s: float | None = None,
                shape_every_s: float = 0.02, start_s: float = 0.0) -> list[Run]:
        """Plays each script on its own copy of this simulation, which is not changed. threads: None: one per core.

        Equals [self.copy().run(script, ..) for script in scripts] to the bit, for any number of threads.
        """
        count = len(os.sched_getaffinity(0)) if threads is None else threads
        runs = self._rollout(list(scripts), count, *_times(duration_s, shape_every_s, start_s))
        return [Run(run) for run in runs]

    @property
    def contacts(self) -> Contacts:
        """The contacts that carried a force in the last time step, as new arrays.

        Empty before the first tick, and with contact.solver = "paper", which keeps no forces. Source:
        firmware/physics/contact_point.hpp.
        """
        return Contacts(*self._contacts())

    def copy(self) -> Self:
        """An independent simulation in the same state."""
        return type(self)(self)

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> Self:
        return self.copy()

    def save(self, path: str | os.PathLike[str] | None = None) -> bytes:
        """The state as bytes, from which load() continues as this simulation would, to the bit. path: also a file.

        The bytes fit the same scene, the same build of ligature and the same kind of CPU. The file appears when it is
        whole.
        """
        image = self._save()
        if path is not None:
            whole = Path(path)
            part = whole.with_name(f"{whole.name}.part-{os.getpid()}-{threading.get_ident()}")
            try:
                part.write_bytes(image)
                part.replace(whole)
            finally:
                part.unlink(missing_ok=True)
        return image

    def load(self, image: bytes | str | os.PathLike[str]) -> Self:
        """Takes over the state that save() has returned or written, `ticks` included. Returns this simulation.

        Raises Refusal for an image of another scene or version, or with damage; nothing is changed then. Load
        only images that you trust: a checksum finds damage, but not an image that was made to do harm.
        """
        self._load(image if isinstance(image, bytes) else Path(image).read_bytes())
        return self

    def set_state(self, nodes: Any, velocities: Any = None) -> None:
        """Sets positions and velocities, and opens both hands. nodes: n x 3, m; velocities: n x 3, m/s, None: at rest.

        Fixed nodes stay where they are. Raises Refusal for another shape, or values that are not finite or beyond 1e9.
        """
        self._set_state(numbers(nodes, "nodes"), None if velocities is None else numbers(velocities, "velocities"))


def _times(duration_s: Any, shape_every_s: Any, start_s: Any) -> tuple[float | None, float, float]:
    duration = None if duration_s is None else number(duration_s, "duration_s")
    return duration, number(shape_every_s, "shape_every_s"), number(start_s, "start_s")
