"""The task `tie`, a run of `ligature-lab`, which has the whole rig in virtual time; and the task `rerun`."""

import csv
import os
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any

import numpy as np

from ligature import Refusal
from ligature import rerun as computed_again
from ligature.inputs import lines_of
from ligature.study.job import Job


def lab() -> str:
    """Path of ligature-lab: $LIGATURE_LAB, which `ligature-lab study` sets, else the one in PATH. Raises Refusal."""
    found = shutil.which(os.environ.get("LIGATURE_LAB") or "ligature-lab")
    if found is None:
        raise Refusal("ligature-lab: not found in PATH, which the task tie needs; remedy: scripts/build, then "
                      "build/dev/bin/ligature-lab study ..., or set LIGATURE_LAB")
    return found


def tie(job: Job) -> dict[str, Any]:
    """The simulated operator ties a knot through the whole chain; the seed is its hand."""
    if job.arguments["scene"] == "by the knot":  # as ligature-lab tie chooses
        job.arguments["scene"] = "paper-long.toml" if job.arguments["knot"].startswith("surgeon") else "paper.toml"
    job.scene()
    settings = [word for line in lines_of(job.overrides) for word in ("--set", line)]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([lab(), "tie", job.arguments["knot"], "--scene", job.file("scene"), "--seeds", str(job.seed), *settings,
                               "--out", folder], capture_output=True, text=True)
        if done.returncode not in (0, 3):  # 3: not tied, which is a result
            said = (done.stderr.strip() or done.stdout.strip() or "no reason given").splitlines()[-1]
            raise RuntimeError(f"exit code {done.returncode}: {said}")
        with open(pathlib.Path(folder) / "results.csv", encoding="utf-8") as file:
            row = next(csv.DictReader(file))
    return {"tied": row["tied"] == "1", "found": row["found"], "seconds": float(row["seconds"]),
            "given_up": row["moves given up"]}


def rerun(job: Job) -> dict[str, Any]:
    """Repeats the thread of a recording with other settings."""
    recording = job.file("recording")
    job.hash_of(recording)
    again = computed_again(recording, job.overrides)
    return {"left_peak_N": again.left_peak_N, "right_peak_N": again.right_peak_N,
            "left_apart_rms_N": again.left_apart_rms_N, "right_apart_rms_N": again.right_apart_rms_N,
            "lost_ticks": float(again.lost_ticks), "tick_us": float(np.median(again.tick_us)) if len(again.tick_us) else 0.0,
            "knot": again.knots[-1][1] if again.knots else ""}
