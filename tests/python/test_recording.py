"""A recording read from Python equals what `ligature-host export` writes, number by number."""

import csv

import numpy as np
import pytest

import ligature
from conftest import SOURCE, run_program

GOLDEN = SOURCE / "tests/fixtures/golden.lcmlog"


@pytest.fixture(scope="module")
def recording():
    return ligature.Recording(GOLDEN)


def table(path):
    with open(path) as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], zip(*rows[1:]), strict=True))


def test_ticks_and_shapes_are_those_of_export(recording, tmp_path):
    done = run_program("ligature-host", "export", GOLDEN, "--ticks", tmp_path / "ticks.csv", "--shape", tmp_path / "shape.csv")
    assert done.returncode == 0, done.stderr
    ticks, shape = table(tmp_path / "ticks.csv"), table(tmp_path / "shape.csv")
    assert set(ticks) == set(recording.ticks) == set(ligature.TICK_COLUMNS)
    for name, cells in ticks.items():
        column = recording.ticks[name]
        assert column.dtype in (np.int64, np.float64) and not column.flags.writeable
        assert np.array_equal(column, np.array(cells, dtype=column.dtype)), name
    nodes = np.concatenate(list(recording.shapes))
    written = np.array([shape[f"{axis}_m"] for axis in "xyz"], dtype=np.float32).T
    assert len(nodes) > 0 and np.array_equal(nodes, written)


def test_shapes_are_found_by_number_and_time(recording):
    shapes = recording.shapes
    assert shapes[0].shape == (len(shapes.tension_N(0)), 3) and len(shapes.turn_rad(-1)) == len(shapes[-1])
    assert shapes.at(shapes.t_s[-1]) == len(shapes) - 1 and shapes.at(-1.0) == 0
    with pytest.raises(IndexError):
        shapes[len(shapes)]


def test_scenes_and_facts(recording):
    assert recording.period_s == 0.001 and recording.max_force_N == 3.3 and recording.firmware_version
    assert recording.scenes and "[suture]" in recording.scenes[0].toml
    assert len(recording.t_s) > 10 and np.all(np.diff(recording.ticks["tick"]) > 0)
    assert recording.events.dtype.names == ("t_s", "tick", "kind", "hand", "code", "text")
    force = recording.vectors("left_device_f", "N")
    assert np.array_equal(force[:, 1], recording.ticks["left_device_f_y_N"])
    with pytest.raises(ligature.Refusal, match="ticks: no column 'left_device_g_x_N'"):
        recording.vectors("left_device_g", "N")


def test_what_is_no_recording_is_refused_in_the_programs_words(tmp_path):
    empty, text, cut = tmp_path / "empty.lcmlog", tmp_path / "text.lcmlog", tmp_path / "cut.lcmlog"
    empty.write_bytes(b"")
    text.write_text("time,hand\n" * 100)
    cut.write_bytes(GOLDEN.read_bytes()[:60])
    for path in (empty, text, cut, tmp_path, tmp_path / "missing"):
        with pytest.raises(ligature.Refusal) as caught:
            ligature.Recording(path)
        done = run_program("ligature-host", "export", path, "--ticks", tmp_path / "ticks.csv")
        assert done.returncode == 2 and done.stderr.strip() == f"ligature-host: {caught.value}"


def test_damage_is_told_and_the_rest_read(recording, tmp_path):
    data = bytearray(GOLDEN.read_bytes())
    data[data.index(b"\xed\xa1\xda\x01", len(data) // 2)] ^= 0xFF  # the bytes with which an event begins
    path = tmp_path / "damaged.lcmlog"
    path.write_bytes(bytes(data))
    damaged = ligature.Recording(path)
    assert damaged.damage != "" and recording.damage == "" and 0 < len(damaged.t_s) <= len(recording.t_s)


def test_a_flight_recorder_is_read_as_export_reads_it(tmp_path):
    (tmp_path / "seeds").mkdir()
    made = run_program("fuzz_flight", "--write", tmp_path / "seeds")
    assert made.returncode == 0, made.stderr
    read = 0
    for path in sorted((tmp_path / "seeds").iterdir()):
        done = run_program("ligature-host", "export", path, "--ticks", tmp_path / "ticks.csv")
        if done.returncode != 0:
            with pytest.raises(ligature.Refusal) as caught:
                ligature.Recording(path)
            assert done.stderr.strip() == f"ligature-host: {caught.value}"
            continue
        recording, written = ligature.Recording(path), table(tmp_path / "ticks.csv")
        assert np.array_equal(recording.ticks["tick"], np.array(written["tick"], dtype=np.int64)) and len(recording.shapes) == 0
        assert np.array_equal(recording.ticks["kinetic_J"], np.array(written["kinetic_J"], dtype=float))
        read += 1
    assert read > 0
