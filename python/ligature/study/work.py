"""What a worker does: one run, from its payload to its row. A run that fails gives a row too, with the reason."""

import datetime
import os
import platform
import time
from typing import Any

import ligature
from ligature._arch import COMMIT
from ligature.study import tasks
from ligature.study.job import Job, divided
from ligature.study.values import Place

PLAIN = (bool, int, float, str, type(None))


def _measured(payload: dict[str, Any], job: Job) -> dict[str, Any]:
    kind = payload["kind"]
    if tasks.is_function(kind):
        values = tasks.function_of(kind, payload["folder"])(payload["task"] | payload["parameters"], payload["seed"])
        if not isinstance(values, dict):
            raise TypeError(f"{kind} returned a {type(values).__name__}, allowed a dict of measures")
    else:
        values = tasks.TASKS[kind].do(job)
    values = {name: value.item() if hasattr(value, "item") else value for name, value in values.items()}
    for name in payload["measures"] or values:
        if not isinstance(values.get(name, values), PLAIN):
            raise TypeError(f"measure '{name}': found {'nothing' if name not in values else type(values[name]).__name__}, "
                            "allowed a number, a text or a truth value")
    return {name: values[name] for name in payload["measures"] or values}


def machine() -> str:
    """Name of this machine and of its CPU."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            cpu = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), platform.machine())
    except OSError:
        cpu = platform.machine()
    return f"{platform.node()}, {cpu}"


def execute(payload: dict[str, Any]) -> dict[str, Any]:
    """Does one run. @returns its row; never raises but for what ends the process."""
    begun_s, children_s = time.process_time(), os.times()
    measures: dict[str, Any] = {}
    reason, job = "", None
    try:
        arguments, overrides = divided(payload["task"] | payload["parameters"])
        if not tasks.is_function(payload["kind"]):
            arguments = tasks.arguments_of(payload["kind"], lambda name: Place("run", name), arguments)
        job = Job(arguments, overrides, payload["seed"], payload["folder"])
        measures = _measured(payload, job)
    except Exception as why:  # whatever a user's function raises
        reason = f"{type(why).__name__}: {why}".replace("\n", " ")[:500]
    now = os.times()
    children = now.children_user + now.children_system - children_s.children_user - children_s.children_system
    return {"run": payload["run"], "seed": payload["seed"], **payload["parameters"], **measures,
            "status": "failed" if reason else "done", "reason": reason, "commit": COMMIT, "version": ligature.__version__,
            "scene_hash": job.scene_hash if job else "", "budget": job.budget if job else 0, "machine": machine(),
            "worker": f"{platform.node()}:{os.getpid()}", "cpu_s": time.process_time() - begun_s + children,
            "ended": datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds")}
