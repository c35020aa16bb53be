"""The tasks of a study: `run` and `pull` here, `tie` and `rerun` in programs.py, and functions of the user's own."""

import importlib
import sys
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ligature import Refusal, Script
from ligature.study.job import Job
from ligature.study.programs import rerun, tie
from ligature.study.pulling import pull
from ligature.study.values import Kind, Number, Place, Text

REQUIRED = object()


class Task(NamedTuple):
    """What a run does, which arguments it takes, and what it measures."""

    do: Callable[[Job], dict[str, Any]]
    arguments: dict[str, tuple[Kind, Any]]
    measures: dict[str, str]  # name: bool, float or text


def run(job: Job) -> dict[str, Any]:
    """Plays a script."""
    simulation = job.simulation(job.scene())
    script = Script.load(job.file("script")) if job.arguments["script"] != "none" else None
    run = simulation.run(script, job.arguments["duration_s"] or None, shape_every_s=1e6)
    if not run.finite:
        raise RuntimeError(run.failure)
    peaks = [float(np.linalg.norm(force_N, axis=1).max(initial=0.0)) for force_N in (run.left_N, run.right_N)]
    return {"knot": run.knot().type, "left_peak_N": peaks[0], "right_peak_N": peaks[1],
            "max_stretch": float(run["max_stretch"].max()), "min_gap_m": float(run["min_gap_m"].min()),
            "kinetic_J": float(run["kinetic_J"][-1])}


SCENE = (Text(), REQUIRED)
TASKS = {
    "run": Task(run, {"scene": SCENE, "script": (Text(), "none"), "duration_s": (Number(0, 1e6), 0)},
                {"knot": "text", "left_peak_N": "float", "right_peak_N": "float", "max_stretch": "float", "min_gap_m": "float",
                 "kinetic_J": "float"}),
    "pull": Task(pull, {"scene": SCENE, "speed_m_per_s": (Number(1e-4, 10), REQUIRED), "force_N": (Number(1e-3, 1e3), 5.0),
                        "hands": (Number(1, 2, whole=True), 2), "settle_s": (Number(0, 100), 0.1),
                        "hold_s": (Number(0, 100), 1.0), "speed_spread": (Number(0, 0.5), 0.0),
                        "least_share": (Number(0, 1), 0.8)},
                 {"locked": "bool", "kept": "bool", "force_left_N": "float", "peak_N": "float", "way_m": "float",
                  "time_lost": "float", "knot": "text", "tick_us": "float"}),
    "tie": Task(tie, {"scene": (Text(), "by the knot"), "knot": (Text(), REQUIRED)},
                {"tied": "bool", "found": "text", "seconds": "float", "given_up": "text"}),
    "rerun": Task(rerun, {"recording": (Text(), REQUIRED)},
                  {"left_peak_N": "float", "right_peak_N": "float", "left_apart_rms_N": "float", "right_apart_rms_N": "float",
                   "lost_ticks": "float", "tick_us": "float", "knot": "text"}),
}


def is_function(kind: str) -> bool:
    """Whether the task is one of the user's own: "module:function"."""
    return ":" in kind


def function_of(kind: str, folder: str) -> Callable[[dict[str, Any], int], dict[str, Any]]:
    """The function of "module:function", whose module may lie beside the study. Raises Refusal."""
    module, _, name = kind.partition(":")
    if folder not in sys.path:
        sys.path.insert(0, folder)
    try:
        found = getattr(importlib.import_module(module), name, None)
    except ImportError as why:
        raise Refusal(f"task {kind}: found no module '{module}' ({why}), allowed one beside the study or installed") from None
    if not callable(found):
        raise Refusal(f"task {kind}: found no function '{name}' in '{module}', allowed a function (parameters, seed) -> dict")
    return found


def arguments_of(kind: str, place: Callable[[str], Place], given: dict[str, Any]) -> dict[str, Any]:
    """The arguments of a task with its defaults. place: where each stands. Raises Refusal for unknown, missing and wrong ones."""
    allowed = TASKS[kind].arguments
    for name in given:
        if name not in allowed:
            raise place(name).refuse("no such key", f"{', '.join(allowed)}, or a key of the scene such as contact.friction")
    checked = {}
    for name, (kind_of_value, default) in allowed.items():
        if name not in given and default is REQUIRED:
            raise place(name).refuse("no value", "a value here or in [parameters]: the task needs it")
        checked[name] = kind_of_value.check(place(name), given[name]) if name in given else default
    return checked
