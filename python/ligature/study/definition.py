"""A study as its file STUDY.toml defines it, read strictly: every mistake is refused before anything is written."""

import os
import pathlib
import tomllib
from typing import Any, Self

from ligature import Scene
from ligature._core import Refusal
from ligature.inputs import Path, path_of
from ligature.study import pictures, tasks
from ligature.study.design import MOST_RUNS, Axis, Design, axis
from ligature.study.job import Job, divided
from ligature.study.programs import lab
from ligature.study.runner import Ended, run
from ligature.study.values import Number, Place, Text, flat, no_others, table

KEYS = ("seeds", "measures", "task", "parameters", "latin", "plot")
BEFORE = ("run", "seed")  # columns of a row, around those of parameters and measures
AFTER = ("status", "reason", "commit", "version", "scene_hash", "budget", "machine", "worker", "cpu_s", "ended")


def _seeds(place: Place, value: Any) -> list[int]:
    if isinstance(value, str):
        first, dash, last = value.partition("-")
        if first.isdecimal() and (last.isdecimal() if dash else not last):
            value = range(int(first), int(last or first) + 1) or value
            if isinstance(value, range) and value[-1] - value[0] >= MOST_RUNS:
                raise place.refuse(f"{first}-{last}", f"at most {MOST_RUNS} seeds")
    seeds = list(value) if isinstance(value, (list, range)) else [value]
    if not seeds or len(set(map(repr, seeds))) < len(seeds):
        raise place.refuse(value, 'different whole numbers, such as [1, 2, 3] or "1-20"')
    return [int(Number(0, 2**32 - 1, whole=True).check(place, seed)) for seed in seeds]


class Study:
    """A study: its design (parameters and seeds), its task and its plots. len() is the number of its runs."""

    def __init__(self, text: str, file: str, folder: str) -> None:
        top = Place(file, "")
        try:
            content = tomllib.loads(text)
        except tomllib.TOMLDecodeError as why:
            raise Refusal(f"{file}: {str(why).splitlines()[0]}, allowed TOML") from None
        no_others(top, content, KEYS)
        self.file: str = file  # how messages call it
        self.text: str = text  # of the file
        self.folder: str = folder  # where its files and its module are searched first
        self.axes: list[Axis] = self._axes(top.of("parameters"), content.get("parameters", {}))
        self.seeds: list[int] = _seeds(top.of("seeds"), content.get("seeds", [1]))
        latin = table(top.of("latin"), content.get("latin", {}))
        no_others(top.of("latin"), latin, ("points", "seed"))
        if any(each.latin for each in self.axes) != bool(latin):
            raise top.of("latin").refuse(latin or "no table", "'points' here, and a parameter with 'latin'; or neither")
        points = Number(1, MOST_RUNS, whole=True).check(top.of("latin").of("points"), latin.get("points", 1))
        drawn = Number(0, 2**32 - 1, whole=True).check(top.of("latin").of("seed"), latin.get("seed", 1))
        self.design: Design = Design(self.axes, self.seeds, int(points), int(drawn))
        if self.design.size > MOST_RUNS:
            raise top.of("parameters").refuse(f"{self.design.size} runs", f"at most {MOST_RUNS}")
        self._read_task(top.of("task"), content.get("task"))
        self.measures: list[str] = self._measures(top.of("measures"), content.get("measures"))
        self.plots: list[dict[str, Any]] = pictures.read(top.of("plot"), content.get("plot", []), self._columns())

    @classmethod
    def load(cls, path: Path) -> Self:
        """Reads a study file. Raises Refusal with file, key, what was found and what is allowed."""
        name = path_of(path)
        try:
            text = pathlib.Path(name).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as why:
            raise Refusal(f"{name}: {getattr(why, 'strerror', None) or why}, allowed a study file (TOML)") from None
        return cls(text, name, os.path.dirname(os.path.abspath(name)))

    def __len__(self) -> int:
        return len(self.design)

    def payload(self, run: int) -> dict[str, Any]:
        """What a worker needs for a run."""
        parameters, seed = self.design[run]
        return {"run": run, "kind": self.kind, "task": self.task, "parameters": parameters, "seed": seed,
                "folder": self.folder, "measures": self.measures}

    def identity(self) -> dict[str, Any]:
        """What rows of one study have in common; plots are not a part of it."""
        return {"task": {"kind": self.kind, **self.task}, "parameters": {each.name: each.values for each in self.axes},
                "log": [each.name for each in self.axes if each.log], "latin": [each.name for each in self.axes if each.latin],
                "runs": len(self), "seeds": self.seeds, "first": self.design[0][0], "last": self.design[len(self) - 1][0],
                "measures": self.measures}

    def run(self, out: Path, **where: Any) -> Ended:
        """Does all runs that have no row in the folder `out` yet, and adds their rows.

        where: `workers=N` (default: one for each core), `scheduler="tcp://HOST:PORT"`, or `slurm=JOBS` with
        `slurm_options={..}` (keywords of dask_jobqueue.SLURMCluster); `retry_failed=True` repeats failed runs;
        `progress`: a text stream, or None. Raises Refusal before anything is written.
        """
        return run(self, path_of(out), **where)

    def plot(self, out: Path) -> list[str]:
        """Writes tables and pictures of the rows in `out`; returns their paths."""
        return pictures.draw(self, path_of(out))

    def _axes(self, place: Place, entries: Any) -> list[Axis]:
        axes = [axis(place.of(name), name, entry) for name, entry in flat(table(place, entries)).items()]
        for each in axes:
            if each.name in BEFORE + AFTER:
                raise place.of(each.name).refuse("a column that each row has", "another name")
        return axes

    def _read_task(self, place: Place, content: Any) -> None:
        if content is None:
            raise place.refuse("no table", "[task] with 'kind' and the task's arguments")
        self.task: dict[str, Any] = flat(table(place, content))
        self.kind: str = Text().check(place.of("kind"), self.task.pop("kind", None))
        if not tasks.is_function(self.kind):
            Text((*tasks.TASKS, "module:function")).check(place.of("kind"), self.kind)
        try:
            if tasks.is_function(self.kind):
                tasks.function_of(self.kind, self.folder)
                return
            if self.kind in ("tie", "rerun"):
                lab()
            for parameters in self.design.samples():
                self._try(parameters)
        except Refusal as why:
            raise why if str(why).startswith(self.file) else Refusal(f"{self.file}: {why}") from None

    def _try(self, parameters: dict[str, Any]) -> None:
        """Reads arguments and scene of one run, as a worker will."""
        arguments, overrides = divided(self.task | parameters)
        checked = tasks.arguments_of(self.kind, lambda name: Place(self.file, "parameters" if name in parameters else "task").of(name),
                                     arguments)
        job = Job(checked, overrides, self.seeds[0], self.folder)
        for name in ("scene", "script", "recording"):
            if name in arguments and checked[name] != "none":
                path = job.file(name)
                if name == "scene":
                    Scene.load(path, overrides)

    def _measures(self, place: Place, value: Any) -> list[str]:
        known = None if tasks.is_function(self.kind) else list(tasks.TASKS[self.kind].measures)
        if value is None:
            return known or []
        if not isinstance(value, list) or not value or any(each in BEFORE + AFTER for each in value):
            raise place.refuse(value, "a list of names, which are no columns of every row")
        return [Text(tuple(known or ())).check(place, each) for each in value]

    def _columns(self) -> list[str] | None:
        """Names of all columns; None if only the function of the study knows its measures."""
        return [*BEFORE, *(each.name for each in self.axes), *self.measures, *AFTER] if self.measures else None
