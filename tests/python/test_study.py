"""Studies: designs, refusals, rows, failed runs, resumption, and the jobs that Slurm would get."""

import json
import math
import os
import random
from concurrent.futures import CancelledError

import dask
import pytest
from distributed import Client, KilledWorker

import ligature
from conftest import BIN, SCENES, SOURCE, run_program
from ligature.study import Study, rows
from ligature.study.cluster import slurm_cluster
from ligature.study.progress import Progress, span
from ligature.study.runner import _Queue
from ligature.study.store import Store
from ligature.study.work import execute
from studies import SEED, called, comparable, stored, study_file

RUN = '[task]\nkind = "run"\nscene = "paper.toml"\nduration_s = 0.02\n'
BAD = [
    ("seeds = ", ": Invalid value"), ("sedes = 3\n" + RUN, "key 'sedes': found no such key, allowed seeds"),
    ("", "key 'task': found no table, allowed [task]"), ('[task]\nkind = "jump"\n', "key 'task.kind': found 'jump', allowed one of run"),
    ('[task]\nkind = "pull"\nscene = "paper.toml"\n', "key 'task.speed_m_per_s': found no value"),
    ('[task]\nkind = "pull"\nscene = "paper.toml"\nspeed_m_per_s = -1\n', "found -1, allowed a number 0.0001 .. 10"),
    ('[task]\nkind = "run"\nscene = "nowhere.toml"\n', "nowhere.toml: found no such file"),
    (RUN + "sped = 3\n", "key 'task.sped': found no such key"),
    (RUN + "[parameters]\ncontact.friction = [0.1, -1]\n", "contact.friction"),
    (RUN + "[parameters]\nsuture.nodes = {from = 10, to = 12, step = 1.5}\n", "suture.nodes"),
    (RUN + "[parameters]\ncontact.friction = 0.3\n", "key 'parameters.contact.friction': found 0.3, allowed a list"),
    (RUN + "[parameters]\ncontact.friction = [0.1, 0.1]\n", "allowed different values"),
    (RUN + "[parameters]\ncontact.friction = {from = 0.3, to = 0.1, count = 3}\n", "found [0.3, 0.1], allowed a smaller and a larger"),
    (RUN + "[parameters]\ncontact.friction = {from = 0.1, to = 0.3}\n", "either 'step' or 'count'"),
    (RUN + "[parameters]\ncontact.friction = {from = 0, to = 0.3, count = 3, log = true}\n", "both above 0"),
    (RUN + "[parameters]\ncontact.friction = {from = 0, to = 1e9, step = 1e-3}\n", "at most 1000000 values"),
    (RUN + "[parameters]\ncontact.friction = {latin = [0.1, 0.3]}\n", "key 'latin': found no table, allowed 'points'"),
    (RUN + "[latin]\npoints = 4\n", "key 'latin'"), (RUN + "[parameters]\nstatus = [1]\n", "key 'parameters.status': found 'a column that each row has', allowed another name"),
    ("seeds = [1, 1]\n" + RUN, "key 'seeds': found [1, 1]"), ('seeds = "9-1"\n' + RUN, "key 'seeds': found '9-1'"),
    ("seeds = [1.5]\n" + RUN, "key 'seeds': found 1.5, allowed an integer"), ('seeds = "1-2000000"\n' + RUN, "key 'seeds': found '1-2000000', allowed at most 1000000 seeds"),
    ('seeds = "1-4294967295"\n' + RUN, "at most 1000000 seeds"), ('seeds = "1-2000"\n' + RUN + f"[parameters]\nsuture.nodes = {list(range(10, 1010))}\n", "found '2000000 runs'"),
    (RUN + "[parameters]\n" + "".join(f"suture.{key} = {{from = 1, to = 2, count = 1000}}\n" for key in "abcdefg"), "runs', allowed at most 1000000"),
    ('measures = ["speed"]\n' + RUN, "key 'measures': found 'speed', allowed one of knot"),
    ('[task]\nkind = "no_such_module:f"\n', "found no module 'no_such_module'"), ('[task]\nkind = "math:nothing"\n', "found no function 'nothing'"),
    (RUN + '[[plot]]\nkind = "map"\nx = "seed"\ny = "width"\n', "key 'plot.y': found 'width', allowed one of run"),
    (RUN + '[[plot]]\nkind = "pie"\n', "key 'plot.kind': found 'pie'"),
    (RUN + '[[plot]]\nkind = "front"\ncost = "cpu_s"\nerror = "kinetic_J"\nname = "a/b"\n', "key 'plot.name'"),
]


def study_of(text, tmp_path):
    path = tmp_path / "own.toml"
    path.write_text(text)
    return Study.load(path)


@pytest.mark.parametrize("text,says", BAD, ids=range(len(BAD)))
def test_refusals(text, says, tmp_path):
    with pytest.raises(ligature.Refusal) as caught:
        study_of(text, tmp_path)
    assert says in str(caught.value) and "\n" not in str(caught.value), str(caught.value)
    assert str(caught.value).startswith(str(tmp_path / "own.toml"))


def test_the_command_refuses_before_it_writes(tmp_path):
    (tmp_path / "own.toml").write_text("seeds = 1\n")
    out = tmp_path / "out"
    for words in ((tmp_path / "own.toml", "--out", out), (tmp_path / "missing.toml", "--out", out), (tmp_path / "own.toml",),
                  (tmp_path / "own.toml", "--out", out, "--workers", 0)):
        done = called(*words)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and not out.exists(), done
    # ligature-lab becomes the same program, and says how to install what is missing.
    done = run_program("ligature-lab", "study", tmp_path / "missing.toml", "--out", out)
    assert done.returncode == 2 and "missing.toml: No such file" in done.stderr and not out.exists(), done


def test_designs(tmp_path):
    study = study_of('seeds = "7-9"\n' + RUN + "[parameters]\ncontact.friction = {from = 0.1, to = 0.5, step = 0.1}\n"
                     "suture.nodes = [20, 10]\nsuture.bend = {from = 1, to = 100, count = 3, log = true}\n", tmp_path)
    assert len(study) == 5 * 2 * 3 * 3
    runs = [study.design[run] for run in range(len(study))]
    assert [run for run, _ in zip(study.design, range(len(study) + 1))] == runs  # a loop over the design ends
    assert len({repr(each) for each in runs}) == len(study) and runs[0] == ({"contact.friction": 0.1, "suture.nodes": 20, "suture.bend": 1.0}, 7)
    assert [runs[18 * i][0]["contact.friction"] for i in range(5)] == [0.1, 0.2, 0.3, 0.4, 0.5]
    assert {each[0]["suture.bend"] for each in runs} == {1.0, 10.0, 100.0}


def test_latin_hypercube(tmp_path):
    seed = random.Random(SEED).randrange(10**6)
    study = study_of(RUN + "[parameters]\ncontact.friction = {latin = [0.0, 0.5]}\nsuture.bend = {latin = [1, 100], log = true}\n"
                     f"[latin]\npoints = 20\nseed = {seed}\n", tmp_path)
    points = [study.design[run][0] for run in range(len(study))]
    parts = [sorted(int(40 * each["contact.friction"]) for each in points), sorted(int(10 * math.log10(each["suture.bend"])) for each in points)]
    assert parts == [list(range(20)), list(range(20))]
    assert len({(int(40 * each["contact.friction"]) - int(10 * math.log10(each["suture.bend"]))) for each in points}) > 2  # shuffled


def test_rows_of_runs(tmp_path):
    """A study's numbers are those of the package, and each row says where it comes from."""
    study = study_of(RUN + "suture.nodes = 12\n[parameters]\nworld.gravity_m_per_s2 = [[0, 0, -9.8], [0, 0, -1.6]]\n", tmp_path)
    assert study.run(tmp_path / "out", workers=1, progress=None) == (2, 0, 0)
    found = rows(tmp_path / "out").to_pylist()
    scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": 12, "world.gravity_m_per_s2": [0, 0, -1.6]})
    assert found[1]["kinetic_J"] == ligature.Simulation(scene).run(duration_s=0.02)["kinetic_J"][-1]
    assert found[1]["world.gravity_m_per_s2"] == "[0, 0, -1.6]" and found[0]["scene_hash"] != found[1]["scene_hash"]
    for row in found:
        assert row["status"] == "done" and len(row["scene_hash"]) == 16 and row["machine"] and row["cpu_s"] > 0 and row["ended"] > "2026"
        assert row["commit"] == "unknown" or len(row["commit"].removesuffix("-changed")) == 40
    with pytest.raises(ligature.Refusal, match="found rows of a study with other seeds"):
        study_of("seeds = 2\n" + study.text, tmp_path).run(tmp_path / "out", progress=None)


def test_failed_runs_are_kept(tmp_path):
    path = study_file(tmp_path, "fails", 5, more='', seeds="1")
    path.write_text('measures = ["square", "odd"]\n' + path.read_text())
    done = called(path, "--out", tmp_path / "out", "--workers", 2)
    assert done.returncode == 3 and "5 of them new, 2 of the new ones failed" in done.stdout, done
    found = rows(tmp_path / "out").to_pylist()
    assert [row["status"] for row in found] == ["done", "done", "failed", "failed", "done"]
    assert found[2]["reason"] == "ValueError: three lines" and "measure 'square': found nothing" in found[3]["reason"]
    assert [row["square"] for row in found] == [2, 5, None, None, 26] and [row["odd"] for row in found][:2] == [True, False]
    assert "0 of them new" in called(path, "--out", tmp_path / "out").stdout  # failed runs are finished, too
    assert "2 of them new" in called(path, "--out", tmp_path / "out", "--workers", 1, "--retry-failed").stdout
    assert sorted(row["run"] for row in stored(tmp_path / "out")) == list(range(5))


def test_a_run_that_ends_its_worker_fails_alone(tmp_path):
    study = Study.load(study_file(tmp_path, "dies", 6, seeds="1"))
    assert study.run(tmp_path / "out", workers=1, progress=None) == (6, 0, 1)
    found = rows(tmp_path / "out").to_pylist()
    assert [row["status"] for row in found] == ["done", "done", "failed", "done", "done", "done"]
    assert found[2]["reason"] == "its worker process died each time" and found[5]["square"] == 37


def test_a_worker_that_restarts_slowly_is_replaced(tmp_path):
    """Dask gives up a worker that is not back after 15 s, and here at once. Then it may also blame an innocent run."""
    study = Study.load(study_file(tmp_path, "dies", 4, seeds="1"))
    with dask.config.set({"distributed.deploy.lost-worker-timeout": "1ms"}):
        assert study.run(tmp_path / "out", workers=1, progress=None)[:2] == (4, 0)
    found = rows(tmp_path / "out").to_pylist()
    assert [row["run"] for row in found] == [0, 1, 2, 3] and found[2]["status"] == "failed"
    assert all(row["status"] == "done" or row["reason"] == "its worker process died each time" for row in found)


@pytest.mark.parametrize("why", [KilledWorker("run-1-0", None, 2), CancelledError()])
def test_a_row_that_is_lost_with_its_worker_is_made_again(tmp_path, why):
    """A run is finished as soon as its worker says so, but the row can still be lost when the worker dies."""
    class Lost:
        status = "finished"

        def result(self):
            raise why

    with Client(processes=False, n_workers=1, dashboard_address=None) as client:
        queue = _Queue(client, Study.load(study_file(tmp_path, "dies", 4, seeds="1")), iter(()))
        assert [queue._row(1, Lost()) for _ in range(2)] == [None, None]
        assert queue._row(1, Lost())["reason"] == "its worker process died each time"


def test_one_thread_in_a_worker(tmp_path):
    Study.load(study_file(tmp_path, "threads", 1, seeds="1")).run(tmp_path / "out", workers=1, progress=None)
    assert rows(tmp_path / "out")["threads"].to_pylist() == ["11"]


def test_store_survives_a_kill_at_each_step(tmp_path):
    """A journal without a part, half a line, a part whose journal is still there, and an unfinished part."""
    row = {"run": 0, "x": 1.5, "status": "done"}
    with Store(tmp_path / "out", {"seeds": [1]}, "") as store:
        store.add(row)
        with pytest.raises(ligature.Refusal, match="another study is running there"), Store(tmp_path / "out", {"seeds": [1]}, ""):
            pass
    journal, parts = tmp_path / "out/journal", tmp_path / "out/rows"
    (journal / "part-000000.jsonl").write_text(json.dumps(row) + "\n")
    (journal / "part-000001.jsonl").write_text(json.dumps(row | {"run": 1}) + "\n" + json.dumps(row | {"run": 2})[:9])
    (parts / ".part-000002.parquet.unfinished").write_text("PAR1")
    with Store(tmp_path / "out", {"seeds": [1]}, "") as store:
        assert store.done() == {0, 1}
        store.add(row | {"run": 2})
    assert [each["run"] for each in stored(tmp_path / "out")] == [0, 1, 2] and not list(journal.iterdir())


def test_pull_locks_as_a_single_simulation_says(tmp_path):
    """Square knots: at friction 0.4 one locks, at 0.2 one slips. Rows are equal, whoever computed them."""
    path = tmp_path / "own.toml"
    path.write_text('[task]\nkind = "pull"\nscene = "suture-3-0-square.toml"\nspeed_m_per_s = 0.3\nhold_s = 0.3\n'
                    "[parameters]\ncontact.friction = [0.2, 0.4]\n")
    study = Study.load(path)
    assert study.run(tmp_path / "out", workers=2, progress=None).failed == 0
    slipped, locked = rows(tmp_path / "out").to_pylist()
    assert not slipped["locked"] and slipped["kept"] and slipped["force_left_N"] < 4
    assert locked["locked"] and locked["knot"] == "3_1#3_1" and locked["budget"] > 1e6 and 0.02 < locked["way_m"] < 0.3
    again = execute(study.payload(1))
    left = comparable([again])[1], comparable([locked])[1]
    assert {**left[0], "tick_us": 0} == {**left[1], "tick_us": 0}


def test_time_lost_is_a_share_of_the_pull(tmp_path):
    """With so small a budget all time is lost, also while the thread rests before the pull: that does not count."""
    text = ('[task]\nkind = "pull"\nscene = "suture-3-0-surgeons.toml"\nspeed_m_per_s = 0.391\nhold_s = 0.01\n'
            "suture.work_instructions = 100000\n")
    row = execute(study_of(text, tmp_path).payload(0))
    assert 0.5 < row["time_lost"] <= 1.0, row


def test_tie_and_rerun_call_the_lab(tmp_path, monkeypatch):
    monkeypatch.setenv("LIGATURE_LAB", str(SOURCE / "nowhere"))
    tie = '[task]\nkind = "tie"\nknot = "overhand"\n'
    with pytest.raises(ligature.Refusal, match="ligature-lab: not found"):
        study_of(tie, tmp_path)
    monkeypatch.setenv("LIGATURE_LAB", str(BIN / "ligature-lab"))
    study_of(tie, tmp_path).run(tmp_path / "tied", workers=1, progress=None)
    tied = rows(tmp_path / "tied").to_pylist()[0]
    assert (tied["status"], tied["tied"], tied["found"]) == ("done", True, "3_1 right") and tied["cpu_s"] > 0.1
    recorded = run_program("ligature-lab", "tie", "overhand", "--scene", SCENES / "paper.toml", "--out", tmp_path / "recorded", "--seeds", 1)
    assert recorded.returncode == 0, recorded
    text = f'[task]\nkind = "rerun"\nrecording = "{tmp_path}/recorded/overhand-1.lcmlog"\n[parameters]\nsuture.bend = [10, 5]\n'
    study_of(text, tmp_path).run(tmp_path / "again", workers=1, progress=None)
    same, softer = rows(tmp_path / "again").to_pylist()
    assert same["left_apart_rms_N"] == 0 and softer["left_apart_rms_N"] > 0 and same["knot"] == softer["knot"] == "3_1"


def test_shipped_studies(monkeypatch):
    monkeypatch.setenv("LIGATURE_LAB", str(BIN / "ligature-lab"))
    shipped = {path.stem: Study.load(path) for path in (SOURCE / "examples/studies").glob("*.toml")}
    assert {name: len(study) for name, study in shipped.items()} == {"locking": 2000, "extremes": 780, "tie": 500, "speeds": 160, "pareto": 216}
    extremes = shipped["extremes"]
    for wanted, ending in ((("paper", "stretch", 0.0, 1e-3), "finite"), (("paper", "stretch", 6.0, 0.1), "stopped"),
                           (("paper", "coupling", 6.0, 1e-3), "refused")):
        run = next(run for run in range(len(extremes)) if tuple(extremes.design[run][0].values()) == wanted)
        row = execute(extremes.payload(run))
        assert row["status"] == "done" and row["ending"] == ending and row["stays_finite"] == (ending == "finite"), row
    pareto = shipped["pareto"]
    errors = {}
    for run, (parameters, _) in enumerate(pareto.design):
        if parameters["model"] == "paper-1" and (parameters["nodes"], parameters["substeps"]) in ((35, 4), (200, 4), (200, 32), (200, 1)):
            row = execute(pareto.payload(run))
            errors[parameters["nodes"], parameters["substeps"]] = row["swing"] if row["status"] == "done" else row["reason"]
    assert 0 < errors[200, 32] < 0.2 * errors[200, 4] < errors[35, 4] < 0.01, errors  # smaller with smaller steps and segments
    assert "diverged" in errors[200, 1], errors


def test_slurm_jobs():
    """What Slurm would get; without Slurm."""
    cluster = slurm_cluster({"queue": "short", "account": "hands", "walltime": "00:10:00", "interface": "lo"})
    try:
        script = cluster.job_script()
    finally:
        cluster.close()
    for line in ("#SBATCH -p short", "#SBATCH -A hands", "#SBATCH -t 00:10:00", "#SBATCH --cpus-per-task=1", "export OMP_NUM_THREADS=1"):
        assert line in script, script
    assert "distributed.cli.dask_worker" in script and "--nthreads 1" in script
    with pytest.raises(ligature.Refusal, match="--slurm-set: .*que"):
        slurm_cluster({"que": "short"})


SBATCH = """#!/bin/sh
# A stand-in for Slurm's sbatch: starts the job's script on this machine, in a session of its own.
cp "$1" {folder}/job-$$.sh
setsid sh {folder}/job-$$.sh > {folder}/job-$$.out 2>&1 &
echo "Submitted batch job $!"
"""
SCANCEL = """#!/bin/sh
echo "$@" >> {folder}/cancelled
kill -TERM -- "-$1"
"""


def test_a_study_in_jobs_of_a_stand_in_for_slurm(tmp_path, monkeypatch):
    """Jobs are submitted, their workers come, do all runs, and are cancelled. Slurm itself is not there."""
    for name, text in (("sbatch", SBATCH), ("scancel", SCANCEL)):
        (tmp_path / name).write_text(text.format(folder=tmp_path))
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    study = Study.load(study_file(tmp_path, "square", 12, more="", seeds="1"))
    ended = study.run(tmp_path / "out", slurm=2, slurm_options={"interface": "lo", "walltime": "00:05:00"}, progress=None)
    assert ended == (12, 0, 0)
    found = rows(tmp_path / "out").to_pylist()
    assert [row["square"] for row in found] == [row["x"] ** 2 + 1 for row in found]
    jobs = list(tmp_path.glob("job-*.sh"))
    assert len(jobs) == 2 and all("#SBATCH -t 00:05:00" in job.read_text() for job in jobs)
    assert len((tmp_path / "cancelled").read_text().split()) == 2, "no job outlives the study"


def test_progress():
    assert [span(each) for each in (4.6, 62, 7320)] == ["5 s", "1 min 2 s", "2 h 2 min"]
    shown = Progress(200, 100, None)
    shown.one_more(False)
    shown.one_more(True)
    assert shown.text(10.0) == f"[{'#' * 15:30}] 102 of 200, 1 failed, 8 min 10 s left"


def test_a_column_may_hold_numbers_in_one_part_and_texts_in_another(tmp_path):
    with Store(tmp_path / "out", {"seeds": [1]}, "") as store:
        for run, value in enumerate((1.5, True, "none", None)):
            store.add({"run": run, "status": "done", "width": value})
            store.flush()
    found = rows(tmp_path / "out").to_pylist()
    assert [row["width"] for row in found] == ["1.5", "true", "none", None] and [row["run"] for row in found] == [0, 1, 2, 3]
