"""A rerun from Python is that of `ligature-lab rerun`."""

import json

import numpy as np
import pytest

import ligature
from conftest import SCENES, SOURCE, run_program

SET = {"contact.friction": 0.05, "suture.bend": 5.0}


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A simulated operator ties an overhand knot."""
    folder = tmp_path_factory.mktemp("rerun") / "tied"
    done = run_program("ligature-lab", "tie", "overhand", "--scene", SCENES / "paper.toml", "--seeds", 1, "--out", folder)
    assert done.returncode == 0, done.stderr
    return folder / "overhand-1.lcmlog"


def same(a, b):
    assert all(np.array_equal(a.ticks[name], b.ticks[name], equal_nan=True) for name in ligature.TICK_COLUMNS)
    assert len(a.shapes) == len(b.shapes) > 10
    assert all(np.array_equal(a.shapes[i], b.shapes[i]) and np.array_equal(a.shapes.turn_rad(i), b.shapes.turn_rad(i)) for i in range(len(a.shapes)))
    assert np.array_equal(a.events, b.events) and a.scenes == b.scenes and a.missing == b.missing


def test_with_the_recorded_settings_it_is_the_recording(log):
    recording = ligature.Recording(log)
    again = ligature.rerun(recording)
    assert again.equal and again.first_difference == "" and again.left_apart_rms_N == again.right_apart_rms_N == 0.0
    assert again.path == str(log) and again.unknown_ticks == 0 and len(again.tick_us) > 0
    columns = ("left_world_f_x_N", "right_world_f_z_N", "kinetic_J", "min_gap_m", "left_device_f_y_N")
    assert all(np.array_equal(again.ticks[name], recording.ticks[name]) for name in columns)
    assert again.knots[-1][1] == "3_1"


def test_with_other_settings_it_is_what_the_lab_writes(log, tmp_path):
    again = ligature.rerun(log, SET)
    done = run_program("ligature-lab", "rerun", log, *(word for key, value in SET.items() for word in ("--set", f"{key}={value}")), "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    same(again, ligature.Recording(tmp_path / "rerun.lcmlog"))
    told = json.loads((tmp_path / "summary.json").read_text())
    assert not again.equal and again.first_difference == told["first_difference"] != ""
    assert [again.left_apart_rms_N, again.right_apart_rms_N] == [told["left_apart_rms_N"], told["right_apart_rms_N"]]
    assert again.right_apart_rms_N > 0.0 and [list(each) for each in again.knots] == told["rerun"]["knot_history"]
    assert again.scenes[0].load().friction == 0.05


def test_refusals_are_those_of_the_lab(log, tmp_path):
    for path, words in ((log, ["suture.nodes=1"]), (log, ["time.tick_s=0.002"]), (SOURCE / "README.md", []), (tmp_path / "no.lcmlog", [])):
        with pytest.raises(ligature.Refusal) as caught:
            ligature.rerun(path, words)
        done = run_program("ligature-lab", "rerun", path, *(each for word in words for each in ("--set", word)))
        assert done.returncode == 2 and done.stderr.strip() == f"ligature-lab: {caught.value}"
    with pytest.raises(ligature.Refusal, match="--session: found 2"):
        ligature.rerun(log, session=2)
