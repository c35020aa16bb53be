"""Shared by the tests of studies: a study in a folder, its command, and its rows without what differs from run to run."""

import subprocess
import sys

import pyarrow.parquet as pq

from seeds import shifted

SEED = shifted(0)
VARYING = ("commit", "machine", "worker", "cpu_s", "ended")

FUNCTIONS = '''
import os
import time

def square(parameters, seed):
    return {"square": parameters["x"] ** 2 + seed, "odd": parameters["x"] % 2 == 1, "name": str(parameters["x"])}

def slow(parameters, seed):
    time.sleep(0.03)
    return square(parameters, seed)

def fails(parameters, seed):
    if parameters["x"] == 3:
        raise ValueError("three\\nlines")
    return {} if parameters["x"] == 4 else square(parameters, seed)

def dies(parameters, seed):
    if parameters["x"] == 3:
        os.kill(os.getpid(), 9)
    return square(parameters, seed)

def threads(parameters, seed):
    return {"threads": os.environ.get("OMP_NUM_THREADS", "") + os.environ.get("OPENBLAS_NUM_THREADS", "")}
'''


def study_file(folder, function, count, seeds="1-2", more=""):
    """Writes a study of a function of FUNCTIONS with x = 1 .. count; returns its path."""
    module = f"functions_{abs(hash(str(folder))) % 10**9}"  # modules stay loaded: another name for each folder
    (folder / f"{module}.py").write_text(FUNCTIONS)
    path = folder / "study.toml"
    path.write_text(f'seeds = "{seeds}"\n[task]\nkind = "{module}:{function}"\n'
                    f"[parameters]\nx = {list(range(1, count + 1))}\n{more}")
    return path


def command(*words):
    """Words that start the command of a study."""
    return [sys.executable, "-m", "ligature.study", *map(str, words)]


def called(*words):
    """Runs the command of a study."""
    return subprocess.run(command(*words), capture_output=True, text=True, timeout=120)


def stored(out):
    """Every row in the parts of a folder, in the order of the files: a run with two rows is there twice."""
    parts = sorted((out / "rows").glob("*.parquet"))
    return [row for part in parts for row in pq.read_table(part).to_pylist()]


def comparable(rows):
    """Rows by run, without what differs from run to run."""
    return {row["run"]: {key: value for key, value in row.items() if key not in VARYING} for row in rows}
