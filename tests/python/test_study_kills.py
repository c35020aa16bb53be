"""Studies whose processes are killed: all rows are there in the end, and none twice."""

import json
import random
import signal
import subprocess
import sys
import time

import pytest
from distributed import Client, LocalCluster

from ligature.study import Study
from ligature.study.work import execute
from studies import SEED, called, command, comparable, stored, study_file


def rows_so_far(out):
    """Lines of journals, and rows of parts."""
    return sum(path.read_bytes().count(b"\n") for path in (out / "journal").glob("*.jsonl")) + len(stored(out)) if out.exists() else 0


def wait_for(condition, limit_s=60):
    end_s = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end_s
        time.sleep(0.01)


def expected(path):
    """Rows of the same study, undisturbed and in this process."""
    study = Study.load(path)
    return comparable(execute(study.payload(run)) for run in range(len(study)))


def test_killed_three_times_and_resumed(tmp_path):
    path, out, draw = study_file(tmp_path, "slow", 60), tmp_path / "out", random.Random(SEED + 1)
    finished = 0
    for _ in range(3):
        process = subprocess.Popen(command(path, "--out", out, "--workers", 2), stderr=subprocess.DEVNULL)
        target = finished + draw.randint(1, 25)
        wait_for(lambda: rows_so_far(out) >= target)
        time.sleep(draw.random() * 0.05)
        process.send_signal(signal.SIGKILL)
        process.wait()
        assert rows_so_far(out) >= finished  # no finished run is lost
        finished = rows_so_far(out)
        assert finished < 120
    done = called(path, "--out", out, "--workers", 2)
    assert done.returncode == 0 and f"120 rows in {out}/rows, {120 - finished} of them new" in done.stdout, done
    found = stored(out)
    assert sorted(row["run"] for row in found) == list(range(120))
    assert comparable(found) == expected(path)


def test_interrupted(tmp_path):
    path, out = study_file(tmp_path, "slow", 60), tmp_path / "out"
    process = subprocess.Popen(command(path, "--out", out, "--workers", 1), stderr=subprocess.PIPE, text=True)
    wait_for(lambda: rows_so_far(out) >= 5)
    process.send_signal(signal.SIGTERM)
    said = process.communicate()[1]
    assert process.returncode == 130 and said.endswith("interrupted; the same command continues it\n"), said
    assert 5 <= len(stored(out)) < 120 and not list((out / "journal").glob("*"))


@pytest.fixture
def scheduler(tmp_path):
    """A scheduler with two workers, each a process of its own."""
    file = tmp_path / "scheduler.json"
    dask = [sys.executable, "-m"]
    local = ["--host", "127.0.0.1"]
    processes = [subprocess.Popen([*dask, "distributed.cli.dask_scheduler", *local, "--port", "0", "--no-dashboard",
                                   "--scheduler-file", file], stderr=subprocess.DEVNULL)]
    wait_for(file.exists)
    for name in ("one", "two"):
        processes.append(subprocess.Popen([*dask, "distributed.cli.dask_worker", *local, "--scheduler-file", file, "--nthreads", "1", "--no-nanny",
                                           "--no-dashboard", "--name", name, "--local-directory", tmp_path / name], stderr=subprocess.DEVNULL))
    address = json.loads(file.read_text())["address"]
    with Client(address) as client:
        client.wait_for_workers(2, timeout=60)
    yield address, processes
    for process in processes:
        process.kill()
        process.wait()


def test_one_of_two_workers_killed(tmp_path, scheduler):
    address, (_, first, _) = scheduler
    path, out = study_file(tmp_path, "slow", 60), tmp_path / "out"
    process = subprocess.Popen(command(path, "--out", out, "--scheduler", address), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    target = random.Random(SEED + 2).randint(5, 60)
    wait_for(lambda: rows_so_far(out) >= target)
    first.kill()
    assert "120 rows" in process.communicate(timeout=60)[0] and process.returncode == 0
    found = stored(out)
    assert sorted(row["run"] for row in found) == list(range(120))
    assert len({row["worker"] for row in found}) == 2 and comparable(found) == expected(path)


def test_schedulers_that_are_refused(tmp_path):
    path, out = study_file(tmp_path, "square", 1), tmp_path / "out"
    done = called(path, "--out", out, "--scheduler", "tcp://127.0.0.1:1", "--workers", 2)
    assert done.returncode == 2 and "found several, allowed one" in done.stderr and done.stderr.count("\n") == 1, done
    with LocalCluster(n_workers=1, threads_per_worker=2, processes=False, protocol="tcp", dashboard_address="127.0.0.1:0") as cluster:
        done = called(path, "--out", out, "--scheduler", cluster.scheduler_address)
    assert done.returncode == 2 and "has 2 threads, allowed 1; remedy" in done.stderr and done.stderr.count("\n") == 1 and not out.exists(), done
