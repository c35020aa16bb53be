"""The tasks `tie` and `rerun`: runs of `ligature-lab`, which has the whole rig in virtual time."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any

from ligature import Refusal
from ligature.inputs import lines_of
from ligature.study.job import Job


def lab() -> str:
    """Path of ligature-lab: $LIGATURE_LAB, which `ligature-lab study` sets, else the one in PATH. Raises Refusal."""
    found = shutil.which(os.environ.get("LIGATURE_LAB") or "ligature-lab")
    if found is None:
        raise Refusal("ligature-lab: not found in PATH, which the tasks tie and rerun need; remedy: scripts/build, then "
                      "build/dev/bin/ligature-lab study ..., or set LIGATURE_LAB")
    return found


def _call(out: str, *words: str | os.PathLike[str], overrides: dict[str, Any], good: tuple[int, ...]) -> pathlib.Path:
    """Runs ligature-lab with a folder of results, which is returned. Raises RuntimeError with its last line."""
    settings = [word for line in lines_of(overrides) for word in ("--set", line)]
    done = subprocess.run([lab(), *words, *settings, "--out", out], capture_output=True, text=True)
    if done.returncode not in good:
        said = (done.stderr.strip() or done.stdout.strip() or "no reason given").splitlines()[-1]
        raise RuntimeError(f"exit code {done.returncode}: {said}")
    return pathlib.Path(out)


def tie(job: Job) -> dict[str, Any]:
    """The simulated operator ties a knot through the whole chain; the seed is its hand."""
    if job.arguments["scene"] == "by the knot":  # as ligature-lab tie chooses
        job.arguments["scene"] = "paper-long.toml" if job.arguments["knot"].startswith("surgeon") else "paper.toml"
    job.scene()
    with tempfile.TemporaryDirectory() as folder:
        out = _call(folder, "tie", job.arguments["knot"], "--scene", job.file("scene"), "--seeds", str(job.seed),
                    overrides=job.overrides, good=(0, 3))  # 3: not tied, which is a result
        with open(out / "results.csv", encoding="utf-8") as file:
            row = next(csv.DictReader(file))
    return {"tied": row["tied"] == "1", "found": row["found"], "seconds": float(row["seconds"]),
            "given_up": row["moves given up"]}


def rerun(job: Job) -> dict[str, Any]:
    """Repeats the thread of a recording with other settings."""
    recording = job.file("recording")
    job.hash_of(recording)
    with tempfile.TemporaryDirectory() as folder:
        out = _call(folder, "rerun", recording, overrides=job.overrides, good=(0, 1))  # 1: recorded settings, other numbers
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    again = summary["rerun"]
    return {"left_peak_N": again["left_peak_N"], "right_peak_N": again["right_peak_N"],
            "left_apart_rms_N": summary["left_apart_rms_N"], "right_apart_rms_N": summary["right_apart_rms_N"],
            "lost_ticks": float(again["lost_ticks"]), "tick_us": again["tick_us"]["median"],
            "knot": again["knot_history"][-1][1] if again["knot_history"] else ""}
