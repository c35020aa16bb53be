"""ligature-lab as called by a user: exit codes, one line on stderr, no partly written files.

Run: python3 command_line_test.py LIGATURE_LAB SCENES"""

import csv
import json
import math
import os
import pathlib
import pty
import signal
import subprocess
import sys
import tempfile
import time

LAB, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
PAPER = str(SCENES / "paper.toml")


def lab(*args):
    return subprocess.run([LAB, *map(str, args)], capture_output=True, text=True, timeout=120)


def refused(folder, *args):
    """Expects exit code 2, one line and no output folder."""
    out = folder / "refused"
    done = lab("run", *args, "--out", out)
    assert done.returncode == 2, (args, done)
    assert done.stderr.count("\n") == 1, (args, done.stderr)
    assert not out.exists(), args
    return done.stderr


def bad_input(folder):
    scene = folder / "bad.toml"
    for text, says in {
        "[suture]\nnodes = 1\n": "bad.toml:2: key 'suture.nodes': found 1, allowed integer 2 .. 5000",
        "[suture]\nlength_m = nan\n": "bad.toml:2: key 'suture.length_m'",
        "[suture]\nwidth = 3\n": "bad.toml:2: unknown key 'suture.width'",
        "[suture]\nradius_m = \"thin\"\n": "bad.toml:2: key 'suture.radius_m'",
    }.items():
        scene.write_text(text)
        assert says in refused(folder, scene)
    assert "cannot be read" in refused(folder, folder / "missing.toml")
    assert "--set suture.nodes=1" in refused(folder, PAPER, "--set", "suture.nodes=1")
    script = folder / "bad.csv"
    script.write_text("time,hand,x,y,z,grip\n0,L,0,0,1,1\n1,L,0,0,1,7\n")
    assert "bad.csv:3: column 'grip': found '7'" in refused(folder, PAPER, "--grippers", script)
    assert "--duration" in refused(folder, PAPER, "--duration", "-1")
    assert "--shape-every" in refused(folder, PAPER, "--shape-every", "0")
    # A number of 300 digits must not be printed in full.
    assert len(refused(folder, PAPER, "--duration", "1e300")) < 120
    for wrong in (["--model", "paper-9"], ["--nodes", "77"], ["--only", "tea"], ["--accuracy", "best"],
                  ["--share", "0"], ["--share", "nan"]):
        done = lab("validate", *wrong)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, (wrong, done)
    measured = folder / "measured.csv"
    measured.write_text("length_m,mass_kg\n1,8e-5\n1,8.1e-5\n1,-1\n")
    for wrong in (["fit", folder / "none.csv"],
                  ["fit", measured, "--out", folder / "refused.toml"]):
        done = lab(*wrong)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, (wrong, done)
    assert not (folder / "refused.toml").exists()
    for args in ([], ["fly"], ["run"], ["run", PAPER, "--nonsense"]):
        done = lab(*args)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, (args, done)


def refused_values():
    """Values that once became a default, or passed a check of their range. They are refused before a file is read."""
    for command, options in {"run": "--grippers --tie --out", "tie": "--scene --models --out --script-out", "play": "--out",
                             "validate": "--only --accuracy --out", "published": "--out", "regress": "--expected --update --scenes",
                             "rerun": "--out", "pareto": "--one --model --published --out", "fit": "--out",
                             "stability": "--scenes --out", "bench": "--out"}.items():
        for option in options.split():
            done = lab(command, option, "")
            assert done.returncode == 2 and done.stderr.count("\n") == 1, (command, option, done)
            assert f"{option}: found ''" in done.stderr, (command, option, done.stderr)
    for command, option, allowed in (("published", "--work", "1e+05 .. 1e+09"), ("play", "--tremor-mm", "0 .. 10"),
                                     ("play", "--lost-share", "0 .. 0.5"), ("play", "--least", "0 .. 1"),
                                     ("play", "--work-share", "0 .. 1")):
        for value in ("nan", "inf", "-1"):
            done = lab(command, option, value)
            assert done.returncode == 2 and f"{option}: found '{value}', allowed {allowed}" in done.stderr, (option, value, done)
    for wrong, says in ((["paper-4/0/1/4"], "allowed NODES 4 .. 5000"), (["paper-4/999999999/1/4"], "allowed NODES 4 .. 5000"),
                        (["paper-4/50/1/0", "--ticks", "-5"], "--ticks: found '-5', allowed 1 .. 1e+06")):
        done = lab("pareto", "--one", *wrong)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and says in done.stderr, (wrong, done)
    script = SCENES / "operators" / "suture-overhand.csv"
    for command in (["tie", "overhand"], ["play", script, "--knot", "overhand"]):
        done = lab(*command, "--scene", PAPER, "--seeds", "1", "--set", "time.tick_s=0.01")
        assert done.returncode == 2, done
        assert "paper.toml: key 'time.tick_s': found 0.01, allowed 0.001 when hands are connected" in done.stderr, done.stderr


def refused_targets(folder):
    """What is no regular file is not replaced, and no input is overwritten; both are seen before any work."""
    weigh, pipe = folder / "pieces.csv", folder / "pipe"
    text = "length_m,mass_kg\n1,7.9e-5\n1,8e-5\n2,16.2e-5\n"
    weigh.write_text(text)
    os.mkfifo(pipe)
    for target in (pipe, "/dev/null", ".", folder / "nowhere" / "x"):
        for command in (["fit", weigh], ["tie", "overhand", "--scene", PAPER, "--seeds", "1", "--out", folder / "tied"]):
            done = lab(*command, "--out" if command[0] == "fit" else "--script-out", target)
            assert done.returncode == 2 and done.stderr.count("\n") == 1 and done.stdout == "", (command, target, done)
            assert "allowed a new or a regular file in a folder that exists" in done.stderr, done.stderr
    assert pipe.is_fifo() and not (folder / "tied").exists()
    (folder / "same.csv").symlink_to(weigh.name)
    for other in (weigh, folder / "same.csv"):
        for wrong, says in (([weigh, "--out", other], "is one of the measurements"), ([weigh, other], "is named twice")):
            done = lab("fit", *wrong)
            assert done.returncode == 2 and says in done.stderr and weigh.read_text() == text, (wrong, done)


def good_run(folder):
    out = folder / "good"
    done = lab("run", PAPER, "--set", "suture.nodes=20", "--duration", "0.5", "--out", out, "--shape-every", "0.1")
    assert done.returncode == 0, done
    with open(out / "trace.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 500 and abs(float(rows[-1]["t_s"]) - 0.5) < 1e-9
    assert all(math.isfinite(float(v)) for row in rows for v in row.values())
    summary = json.loads((out / "summary.json").read_text())
    assert summary["ticks"] == 500 and summary["finite"] and summary["nodes"] == 20
    assert summary["knot"] == {"type": "0_1", "handedness": "none"}
    assert summary["knot_history"] == [[0.0, "0_1"]]


def fitted(folder):
    measured, out = folder / "weigh.csv", folder / "thread.toml"
    measured.write_text("# by hand\nlength_m,mass_kg\n1,7.9e-5\n1,8e-5\n2,16.2e-5\n")
    done = lab("fit", measured, "--out", out)
    assert done.returncode == 0, done
    lines = out.read_text().splitlines()
    assert lines[:2] == ["[suture]", 'model = "rod"'] and len(lines) == 3, lines
    key, value = lines[2].split("#")[0].split("=")
    assert key.strip() == "density_kg_per_m" and abs(float(value) - 8e-5) < 1e-8, lines
    scene = folder / "mine.toml"
    scene.write_text(out.read_text() + "\n[hands]\ncoupling_N_per_m = 100\n")
    done = lab("run", scene, "--set", "suture.nodes=20", "--duration", "0.01", "--out", folder / "mine")
    assert done.returncode == 0, done
    # The other lines are written, although one value is left out.
    load = folder / "shorter.csv"
    load.write_text("load_N,length_m\n0,0.5\n1,0.4\n2,0.3\n")
    done = lab("fit", measured, load, "--out", out)
    assert done.returncode == 3 and "left out" in done.stderr and "EA_N" in done.stderr, done
    assert "density_kg_per_m" in out.read_text() and "EA_N" not in out.read_text() + done.stdout, (out.read_text(), done)


def failed_run(folder):
    done = lab("run", PAPER, "--set", "time.tick_s=0.05", "--set", "suture.integrator=forward", "--duration", "500",
               "--shape-every", "10", "--out", folder / "failed")
    assert done.returncode == 3, done
    assert done.stderr.count("\n") == 1 and "likely cause" in done.stderr, done.stderr
    assert not json.loads((folder / "failed" / "summary.json").read_text())["finite"]


def validation(folder):
    out = folder / "validate"
    done = lab("validate", "--only", "elastic-string", "--nodes", "50", "--out", out)
    assert done.returncode == 0 and "PASS" in done.stdout and "FAIL" not in done.stdout, done
    rows = list(csv.DictReader((out / "validate.csv").open()))
    assert rows and all(row["verdict"] == "PASS" for row in rows)
    assert len(json.loads((out / "validate.json").read_text())) == len(rows)
    done = lab("validate", "--only", "capstan", "--nodes", "50", "--model", "paper-4")
    assert done.returncode == 0 and "not modelled" in done.stdout, done
    # A limit that no solution meets.
    done = lab("validate", "--only", "elastic-string", "--nodes", "50", "--share", "1e-9")
    assert done.returncode == 1 and "FAIL" in done.stdout, done


def interrupted_in(step, *args):
    """Interrupts a command when its line of progress, which only a terminal gets, names a step. @return exit code, output, errors"""
    terminal, end = pty.openpty()
    with subprocess.Popen([LAB, *map(str, args)], stdout=subprocess.PIPE, stderr=end, text=True) as command:
        os.close(end)
        said = ""
        try:
            while step not in said:
                said += os.read(terminal, 4096).decode()
            command.send_signal(signal.SIGINT)
            out = command.communicate(timeout=100)[0]
        finally:
            command.kill()
        said += os.read(terminal, 4096).decode()
        os.close(terminal)
    return command.returncode, out, said


def interruption(folder):
    """What was measured before is printed and written; a command that measured nothing says so."""
    code, out, said = interrupted_in("overhand-hysteresis, N = 200", "validate", "--only", "overhand-hysteresis", "--nodes", 200)
    assert (code, out) == (130, ""), (code, out)
    assert "ligature-lab: validate: interrupted in overhand-hysteresis, nothing measured" in said, said
    code, out, said = interrupted_in("overhand-hysteresis, N = 200", "validate", "--only", "overhand-hysteresis", "--out", folder)
    assert code == 130 and "1 judged, 0 failed" in out, (code, out)
    assert "validate: interrupted in overhand-hysteresis; what was measured before is above" in said, said
    assert {row["nodes"] for row in csv.DictReader((folder / "validate.csv").open())} == {"50"}
    code, out, said = interrupted_in("paper-overhand", "regress", "desk", "paper-overhand", "--scenes", SCENES)
    assert code == 130 and "GONE" not in out and "0 beyond" in out, (code, out)
    assert "regress: interrupted in paper-overhand; what was measured before is above" in said, said


def stopped_at(file, number, *args):
    """Sends a signal once a file exists. @return exit code, errors"""
    with subprocess.Popen([LAB, *map(str, args)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as command:
        while command.poll() is None and not file.exists():
            time.sleep(0.02)
        command.send_signal(number)
        try:
            complaint = command.communicate(timeout=100)[1]
        finally:
            command.kill()
    return command.returncode, complaint


def interrupted_experiments(folder):
    """An experiment that is interrupted has no verdict, and no table with cells that it did not measure."""
    for step, command in (("default, N = 20", ["stability"]), ("overhand, N = 35", ["experiment", "knotting"]), ("N = 20", ["bench"]),
                          ("stretch_N x", ["extremes"])):
        out = folder / command[-1]
        code, _, said = interrupted_in(step, *command, "--scenes", SCENES, "--out", out)
        assert code == 130 and f"ligature-lab: {command[-1]}: interrupted; " in said, (command, code, said)
        assert not list(out.iterdir()), list(out.iterdir())
    out = folder / "models"
    code, said = stopped_at(out / "models-shapes.csv.part", signal.SIGTERM, "experiment", "models", "--scenes", SCENES, "--out", out)
    assert code == 130 and said.startswith("ligature-lab: models: interrupted; ") and not list(out.iterdir()), (code, said)


def interrupted_play(folder):
    """A long run ends at the signal; its recording, which is not whole, is removed."""
    script = folder / "long.csv"
    keys = [line for line in (SCENES / "operators" / "suture-overhand.csv").read_text().splitlines() if line.startswith("0,")]
    script.write_text("\n".join(["time,hand,x,y,z,grip", *keys, keys[-1].replace("0,", "3000,", 1)]) + "\n")
    out = folder / "played"
    code, complaint = stopped_at(out / "overhand-1.lcmlog.part", signal.SIGTERM, "play", script, "--scene", SCENES / "suture-3-0.toml",
                                 "--knot", "overhand", "--seeds", "1-2", "--out", out)
    assert (code, complaint) == (130, "") and not list(out.glob("*")), (code, complaint, list(out.glob("*")))


def interrupted_run(folder):
    """What was run is kept, and the exit code says that it is not the whole. trace.csv.part grows once the run has begun."""
    trace = folder / "trace.csv.part"
    with subprocess.Popen([LAB, "run", PAPER, "--duration", "100000", "--out", folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as run:
        while run.poll() is None and not (trace.exists() and trace.stat().st_size > 10_000):
            time.sleep(0.02)
        run.send_signal(signal.SIGINT)
        out, complaint = run.communicate(timeout=100)
    assert run.returncode == 130, (run.returncode, out, complaint)
    assert complaint.startswith("ligature-lab: interrupted at t = "), complaint
    assert json.loads((folder / "summary.json").read_text())["interrupted"]


def interrupted_published(folder):
    """The cases before the interruption are printed and written."""
    with subprocess.Popen([LAB, "published", "helices", "cyclic", "--settings", "balanced", "--out", folder], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as published:
        first = published.stdout.readline()
        published.send_signal(signal.SIGINT)
        out, complaint = published.communicate(timeout=100)
    assert published.returncode == 130, (published.returncode, out, complaint)
    assert first.startswith("helices, balanced: "), first
    assert complaint == "published: interrupted in cyclic, balanced; what was measured before is above\n", complaint
    assert {row["case"] for row in csv.DictReader((folder / "published.csv").open())} == {"helices"}
    assert (folder / "helices.csv").exists() and not (folder / "cyclic.csv").exists()


def recordings(folder):
    """A recording of an earlier call is replaced only with --force; without it the program refuses before it runs
    anything."""
    script = SCENES / "operators" / "suture-overhand.csv"
    there = folder / "overhand-3.lcmlog"
    for command in (["tie", "overhand", "--scene", PAPER], ["play", script, "--scene", SCENES / "suture-3-0.toml", "--knot", "overhand"]):
        there.write_text("an earlier one")
        done = lab(*command, "--seeds", "1-5", "--out", folder)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, done
        assert "overhand-3.lcmlog: exists" in done.stderr and "--force" in done.stderr, done.stderr
        assert [path.name for path in folder.iterdir()] == [there.name] and there.read_text() == "an earlier one"
    with subprocess.Popen([LAB, "tie", "overhand", "--scene", PAPER, "--seeds", "3-5", "--force", "--out", folder], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as tie:
        for line in tie.stdout:
            if line.split()[0] == "3":
                break
        tie.send_signal(signal.SIGINT)
        tie.communicate(timeout=100)
    assert tie.returncode == 130, tie.returncode
    assert there.stat().st_size > 10_000  # with --force the earlier file has been replaced
    rows = list(csv.DictReader((folder / "results.csv").open()))
    assert rows[0]["knot"] == "overhand" and rows[0]["seed"] == "3" and rows[0]["found"].startswith("3_1"), rows
    assert len(rows) < 3
    # Every recording has its row, and a later call adds its rows to those.
    assert {path.name for path in folder.iterdir()} == {"results.csv", *(f"overhand-{row['seed']}.lcmlog" for row in rows)}
    for _ in range(2):
        lab("tie", "overhand", "--scene", PAPER, "--seeds", "8", "--force", "--out", folder)
        assert list(csv.DictReader((folder / "results.csv").open()))[:-1] == rows
    assert list(csv.DictReader((folder / "results.csv").open()))[-1]["seed"] == "8"


def regression(folder):
    assert lab("regress", "desk", "--scenes", SCENES).returncode == 0
    text = "scene,figure,expected,tolerance\ndesk,distance until it stops (mm),1,0.1\ndesk,no such figure,1,0.1\n"
    expected = folder / "expected.csv"
    expected.write_text(text)
    done = lab("regress", "desk", "--expected", expected, "--scenes", SCENES)
    assert done.returncode == 3, done
    assert all(word in done.stdout for word in ("BEYOND", "NEW", "GONE")), done.stdout
    for wrong in (["--update", expected], ["tea"], ["desk", "--update", folder / "new.csv"], ["--expected", folder / "none.csv"]):
        done = lab("regress", *wrong)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, (wrong, done)
    assert expected.read_text() == text and not (folder / "new.csv").exists()


def teaching():
    assert lab("--version").stdout.startswith("ligature-lab ")
    assert "Example" in lab("run", "--help").stdout


with tempfile.TemporaryDirectory() as name:
    bad_input(pathlib.Path(name))
    refused_values()
    refused_targets(pathlib.Path(name))
    good_run(pathlib.Path(name))
    fitted(pathlib.Path(name))
    failed_run(pathlib.Path(name))
    validation(pathlib.Path(name))
    regression(pathlib.Path(name))
with tempfile.TemporaryDirectory() as name:
    recordings(pathlib.Path(name))
with tempfile.TemporaryDirectory() as name:
    interruption(pathlib.Path(name))
with tempfile.TemporaryDirectory() as name:
    interrupted_experiments(pathlib.Path(name))
with tempfile.TemporaryDirectory() as name:
    interrupted_play(pathlib.Path(name))
with tempfile.TemporaryDirectory() as name:
    interrupted_run(pathlib.Path(name))
with tempfile.TemporaryDirectory() as name:
    interrupted_published(pathlib.Path(name))
teaching()
print("ligature-lab: command line behaves")
