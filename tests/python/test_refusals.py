"""Errors in input are reported with the same text as by the programs."""

import pathlib

import numpy as np
import pytest

import ligature
from conftest import OVERHAND, SCENES, run_program

PAPER = SCENES / "paper.toml"


def said_by_the_lab(*args):
    done = run_program("ligature-lab", "run", *args, "--out", "/nonexistent/never")
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done
    return done.stderr.removeprefix("ligature-lab: ").rstrip("\n")


def refusal(call, *args, **kwargs):
    with pytest.raises(ligature.Refusal) as caught:
        call(*args, **kwargs)
    assert isinstance(caught.value, ValueError) and "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("text", [
    "[suture]\nnodes = 1\n", "[suture]\nlength_m = nan\n", "[suture]\nwidth = 3\n", '[suture]\nradius_m = "thin"\n', "[sutur]\n", "",
    "[suture]\nnodes = [\n", "[suture]\ninitial = \"nowhere.csv\"\n", "[suture]\nmodel = \"rod\"\nnodes = 3\n",
    "[suture]\n[contact]\nfriction = -1\n", "\0", "\x80\xff", "[suture]\nname = \"\u00e4\"\n",
])
def test_scene_files(text, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_bytes(text.encode("utf-8"))
    assert refusal(lambda: ligature.Simulation(ligature.Scene.load(path))) == said_by_the_lab(path)


def test_files_that_are_none(tmp_path):
    (tmp_path / "latin.toml").write_bytes(b"[suture]\nmodel = \"\xe4\"\n")
    for path in (tmp_path / "missing.toml", tmp_path, "", tmp_path / "latin.toml", pathlib.Path("/dev/zero")):
        assert refusal(ligature.Scene.load, path) == said_by_the_lab(path), path
    for path in (b"paper.toml", "a\0b", "\ud800"):
        assert refusal(ligature.Scene.load, path).startswith("path: ")
    with pytest.raises(TypeError):
        ligature.Scene.load(7)


@pytest.mark.parametrize("line", ["suture.nodes=1", "suture.nodes", "=3", "suture.nodes=", "suture.model=paper-9", "a.b.c=1",
                                  "world.fixed=[{node=99, position_m=[0,0,0]}]", "suture.nodes=2, 3", "contact.friction=inf"])
def test_overrides(line):
    expected = said_by_the_lab(PAPER, "--set", line)
    assert refusal(ligature.Scene.load, PAPER, [line]) == expected
    if line.count("=") == 1 and line.index("=") > 0:
        assert refusal(ligature.Scene.load, PAPER, dict([line.split("=")])) == expected


def test_overrides_of_python_values():
    scene = ligature.Scene.load(PAPER, {"suture.nodes": np.int64(30), "contact.friction": 0.25, "world.grippers_collide": True,
                                        "suture.model": "paper-3", "world.loads": [{"node": -1, "force_N": (0, 0, -1e-3)}]})
    assert (scene.nodes, scene.friction, scene.model) == (30, 0.25, "paper-3")
    assert "found nan" in refusal(ligature.Scene.load, PAPER, {"contact.friction": float("nan")})
    assert "found 1, allowed" in refusal(ligature.Scene.load, PAPER, {"suture.nodes": 1})
    assert refusal(ligature.Scene.load, PAPER, {"suture.nodes": object()}).startswith("overrides: found a object")


@pytest.mark.parametrize("text", ["time,hand\n", "time,hand,x,y,z,grip\n0,L,0,0,nan,1\n", "time,hand,x,y,z,grip\n0,M,0,0,0,1\n",
                                  "time,hand,x,y,z,grip\n1,L,0,0,0,1\n1,L,0,0,0,0\n", "time,hand,x,y,z,grip\n0,L,0,0,0,2\n"])
def test_scripts(text, tmp_path):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    assert refusal(ligature.Script.load, path) == said_by_the_lab(PAPER, "--grippers", path)


def test_keys_of_scripts():
    for keys, says in {
        "left: found an array of 1 x 4, allowed n x 5": [[0, 0, 0, 0]],
        "left: row 0, column 'grip': found 2, allowed 0 or 1": [[0, 0, 0, 0, 2]],
        "left: row 0, column 'time': found -1, allowed 0 .. 1e6": [[-1, 0, 0, 0, 0]],
        "left: row 1, column 'time': found 1, allowed later than the row before it": [[1, 0, 0, 0, 0], [1, 0, 0, 0, 0]],
        "left: row 0, column 1: found nan, allowed -1e+06 .. 1e+06": [[0, float("nan"), 0, 0, 0]],
        "left: found an array of <U1, allowed numbers": "x",
        "left: found no array of numbers, allowed rows of equally many": [[1, 2], [3]],
    }.items():
        assert refusal(ligature.Script.of_keys, says) == keys
    turning = ligature.Script.of_keys(right=[[0, 1, 2, 3, 1, 0, 0, 0], [2, 1, 2, 5, 1, 0, 90, 0]])
    assert turning.end_s == 2.0 and turning.tools(1.0)[1].p_W_m == [1.0, 2.0, 4.0] and turning.tools(1.0)[1].grip


def test_times(paper):
    sim = ligature.Simulation(paper)
    expected = said_by_the_lab(PAPER, "--duration", "1e-9")
    assert refusal(sim.run, duration_s=1e-9) == expected.replace("--duration", "duration_s")
    expected = said_by_the_lab(PAPER, "--shape-every", "0")
    assert refusal(sim.run, shape_every_s=0) == expected.replace("--shape-every", "shape_every_s")
    for kwargs in ({"duration_s": float("nan")}, {"duration_s": "long"}, {"shape_every_s": float("inf")}, {"start_s": -1.0}, {"duration_s": 10**400}):
        assert refusal(sim.run, **kwargs).startswith(next(iter(kwargs)) + ": found ")
    assert "which keeps " in refusal(sim.run, duration_s=1e6)
    assert "which keeps" in refusal(sim.rollout, [ligature.Script()] * 1000, duration_s=1e5)
    assert refusal(sim.rollout, [ligature.Script()], threads=0) == "threads: found 0, allowed 1 .. 256"
    assert sim.ticks == 0


def test_states_and_points(paper):
    sim = ligature.Simulation(paper)
    before = sim.nodes.copy()
    assert refusal(sim.set_state, np.zeros((19, 3))) == "nodes: found 19 rows, allowed 20"
    assert refusal(sim.set_state, np.zeros((20, 2))) == "nodes: found an array of 20 x 2, allowed n x 3"
    assert refusal(sim.set_state, before, np.full((20, 3), np.inf)).startswith("velocities: row 0, column 0: found inf")
    assert np.array_equal(sim.nodes, before)
    assert refusal(ligature.knot, [1, 2, 3]) == "points: found an array of 3, allowed n x 3"
    assert refusal(ligature.knot, np.zeros((20001, 3))) == "points: found 20001, allowed 20000 at most"
    assert refusal(ligature.knot, [[0, 0, 1e10]]) == "points: row 0, column 2: found 1e+10, allowed -1e+09 .. 1e+09"


def test_a_cpu_that_lacks_something_is_told():
    from ligature import cpu

    assert cpu.lacking("x86-64-v3", "flags\t: fpu avx sse4_2\n") == ["avx2", "fma", "bmi2"]
    assert cpu.lacking("x86-64-v3", "Features: neon\n") == [] and cpu.lacking("native", "flags : fpu\n") == []
    assert ligature.Script.load(OVERHAND).end_s > 20.0
