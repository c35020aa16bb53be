"""Python computes exactly what `ligature-lab run` writes. Its files hold each number with as many digits as are needed
to read it back bit by bit."""

import csv
import pathlib

import numpy as np
import pytest

import ligature
from conftest import OVERHAND, SCENES, run_program

PULL = """time,hand,x,y,z,grip
0,L,{l[0]},{l[1]},{l[2]},1
0,R,{r[0]},{r[1]},{r[2]},1
0.05,L,{l[0]},{l[1]},{l[2]},1
0.05,R,{r[0]},{r[1]},{r[2]},1
0.4,L,{a[0]},{a[1]},{a[2]},1
0.4,R,{b[0]},{b[1]},{b[2]},1
"""
CASES = [("paper", 3.0), ("paper-long", 1.0), ("desk", 3.0), ("suture-3-0-knot", 0.4), ("suture-3-0-square", 0.4)]


def script_for(name, folder):
    """The shipped overhand; for realistic threads a script that pulls both ends apart."""
    if not name.startswith("suture"):
        return OVERHAND
    nodes = ligature.Simulation(ligature.Scene.load(SCENES / f"{name}.toml")).nodes
    l, r = nodes[5], nodes[-6]
    apart = 0.02 * (r - l) / np.linalg.norm(r - l)
    path = folder / "pull.csv"
    path.write_text(PULL.format(l=l, r=r, a=l - apart, b=r + apart))
    return path


def rows(path):
    with open(path) as file:
        return np.array([[float(cell) for cell in row] for row in list(csv.reader(file))[1:]])


def lab_run(name, script, duration_s, out):
    done = run_program("ligature-lab", "run", SCENES / f"{name}.toml", "--grippers", script, "--duration", duration_s, "--out", out,
                       "--shape-every", 0.03)
    assert done.returncode == 0, done.stderr
    return rows(out / "trace.csv"), rows(out / "shape.csv")


@pytest.mark.parametrize("name,duration_s", CASES)
def test_equal_to_the_bit(name, duration_s, tmp_path):
    script = script_for(name, tmp_path)
    trace, shape = lab_run(name, script, duration_s, tmp_path / "out")
    scene = ligature.Scene.load(SCENES / f"{name}.toml")
    run = ligature.Simulation(scene).run(ligature.Script.load(script), duration_s, shape_every_s=0.03)
    assert run.finite and run.failure == ""
    assert np.array_equal(run.trace, trace[:, :12])  # without the last column, the cost of a tick
    assert np.array_equal(np.repeat(run.shape_t_s, scene.nodes), shape[:, 0])
    assert np.array_equal(run.shapes.reshape(-1, 3), shape[:, 2:])
    if name != "paper-long":  # there the hands reach the thread only after the end of this run
        assert np.abs(run["left_fx_N"]).max() > 0.0, "no hand felt anything"


@pytest.mark.parametrize("name,duration_s", CASES)
def test_tick_by_tick_is_the_run(name, duration_s, tmp_path):
    """A Python loop over tick() computes the same as run()."""
    scene = ligature.Scene.load(SCENES / f"{name}.toml")
    script = ligature.Script.load(script_for(name, tmp_path))
    run = ligature.Simulation(scene).run(script, 0.3)
    own = ligature.Simulation(scene)
    for tick in range(len(run.trace)):
        assert own.tick(*script.tools((tick + 1) * scene.tick_s))
        d = own.diagnostics
        row = [*own.left.f_W_N, *own.right.f_W_N, d.kinetic_J, d.potential_J, d.max_stretch, min(d.min_gap_m, scene.length_m), d.contacts]
        assert np.array_equal(run.trace[tick, 1:], row), f"tick {tick}"
    assert np.array_equal(own.nodes, run.shapes[-1])


def test_a_run_that_diverges_says_what_the_program_says(tmp_path):
    changes = ["time.tick_s=0.05", "suture.integrator=forward"]
    done = run_program("ligature-lab", "run", SCENES / "paper.toml", "--duration", 500, "--out", tmp_path,
                       *(word for change in changes for word in ("--set", change)))
    assert done.returncode == 3
    run = ligature.Simulation(ligature.Scene.load(SCENES / "paper.toml", changes)).run(duration_s=500)
    assert not run.finite
    assert done.stderr.strip().endswith(run.failure)
    assert np.array_equal(run.trace, rows(pathlib.Path(tmp_path) / "trace.csv")[:, :12])
