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


def same(a, b):
    """Equal to the bit, except that JSON has no infinities: they come back as NaN."""
    if a.dtype.kind == "f":
        a = np.where(np.isinf(a), np.nan, a)
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=True) and np.array_equal(np.signbit(a), np.signbit(b))
    return a.dtype == b.dtype and np.array_equal(a, b)


def test_an_mcap_file_has_the_columns_of_its_log(recording, tmp_path):
    done = run_program("ligature-host", "export", GOLDEN, "--mcap", tmp_path / "golden.mcap")
    assert done.returncode == 0, done.stderr
    again = ligature.Recording(tmp_path / "golden.mcap")
    assert list(again.ticks) == list(recording.ticks)
    for name, column in recording.ticks.items():
        assert same(column, again.ticks[name]) and not again.ticks[name].flags.writeable, name
    assert len(again.shapes) == len(recording.shapes) > 0
    for name in ("t_s", "tick", "radius_m"):
        assert same(getattr(recording.shapes, name), getattr(again.shapes, name)), name
    assert all(same(a, b) for a, b in zip(recording.shapes, again.shapes, strict=True))
    assert again.scenes == recording.scenes and np.array_equal(again.events, recording.events)
    facts = ("period_s", "max_force_N", "firmware_version", "missing", "damage")
    assert [getattr(again, fact) for fact in facts] == [getattr(recording, fact) for fact in facts]
    with pytest.raises(ligature.Refusal, match="found no tension_N, as in MCAP files"):
        again.shapes.tension_N(0)


def test_a_damaged_or_foreign_mcap_file_is_refused_in_one_line(tmp_path):
    done = run_program("ligature-host", "export", GOLDEN, "--mcap", tmp_path / "golden.mcap")
    assert done.returncode == 0, done.stderr
    whole = (tmp_path / "golden.mcap").read_bytes()
    damaged = bytearray(whole)
    damaged[len(whole) // 2] ^= 0xFF
    for data in (whole[:-50], whole[:100], whole[:8], bytes(damaged)):
        (tmp_path / "bad.mcap").write_bytes(data)
        with pytest.raises(ligature.Refusal, match=r"^[^\n]*bad\.mcap: found a damaged MCAP file[^\n]*$"):
            ligature.Recording(tmp_path / "bad.mcap")


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
