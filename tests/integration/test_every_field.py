"""Every field of tick, thread, status and event, from the encoded message to CSV, HDF5 and MCAP.

Fields are enumerated from the .lcm definitions, and each number of a message is unique. Therefore swapped columns,
fields missing from a format, and columns without a field are found. The path to the message is tested by EveryField.*.
"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(os.environ["LIGATURE_SOURCE"])
HOST = pathlib.Path(os.environ["LIGATURE_BIN"]) / "ligature-host"
sys.path.insert(0, os.environ["LIGATURE_LCM_PYTHON"])

import h5py  # noqa: E402
import lcm  # noqa: E402
from ligature_msg import event_t, status_t, thread_t, tick_batch_t, tick_t  # noqa: E402
from mcap.reader import make_reader  # noqa: E402

HANDS, TICKS, SHAPES, EVENTS, SESSION = ("left", "right"), 7, 3, 4, 99
NOTES = ("a \"note\", typed by a person", "µ = 0.3")
# Columns have their fields' names, except for vectors: here their quantity, unit and axes.
VECTORS = {"p_WT_m": ("p_WT", "_m", "xyz"), "v_WT_m_per_s": ("v_WT", "_m_per_s", "xyz"), "f_world_N": ("world_f", "_N", "xyz"),
           "f_device_N": ("device_f", "_N", "xyz"), "f_wish_N": ("wish_f", "_N", "xyz"), "q_rad": ("q", "_rad", "123"),
           "torque_permille": ("torque", "_permille", "123"), "tool_p_W_m": ("tool_p_W", "_m", "xyz"), "tool_v_W_m_per_s": ("tool_v_W", "_m_per_s", "xyz")}
NUMBERED = {"step_age_ticks": "step_{}_age_ticks", "step_cut_at": "step_{}_cut_at"}
RENAMED = {"grasped_node": "node"}
UNITS = (("_m_per_s", "m/s"), ("_N_s_per_m", "N s/m"), ("_permille", "1/1000 of rated"), ("_ticks", "ticks"), ("_rad", "rad"), ("_ns", "ns"),
         ("_m", "m"), ("_N", "N"), ("_J", "J"), ("_s", "s"))
# Fields that exports leave out: sending times (a row has its tick's time), row counts, held nodes (the tick has them),
# and what a status says about its own moment (shown by `report` and the page).
LEFT_OUT = {"tick_t": set(), "thread_t": {"utime", "grasped_node"}, "event_t": {"utime"},
            "status_t": {"utime", "session", "protocol_version", "recorder_file", "state", "fault", "deadline_misses", "periods_lost", "realtime",
                         "armed", "admitted", "tick"}}


def fields_of(name):
    """(type, field, sizes) of each field of a definition, in order."""
    text = re.sub(r"//[^\n]*", "", (ROOT / f"protocol/lcm/{name}.lcm").read_text()).split("{", 1)[1]
    return [(kind, field, re.findall(r"\[(\w+)\]", sizes)) for kind, field, sizes in re.findall(r"(\w+)\s+(\w+)((?:\[\w+\])*)\s*;", text)]


class Numbers:
    """Unique numbers: integers as large as the type allows, fractions that are exact in a float."""

    def __init__(self):
        self.count = 0

    def next(self, kind):
        self.count += 1
        if kind in ("float", "double"):
            return self.count + 0.5 if kind == "float" else self.count + 1 / 3
        return self.count if kind != "int8_t" else self.count % 127


def fill(message, name, numbers, sizes):
    """Fills every field of a message from its definition. @param sizes lengths of the arrays that a field gives."""
    for kind, field, dimensions in fields_of(name):
        def value(left):
            if left:
                return [value(left[1:]) for _ in range(sizes[left[0]] if left[0] in sizes else int(left[0]))]
            return f"{field} of {numbers.next('string')}" if kind == "string" else numbers.next(kind)
        setattr(message, field, sizes[field] if field in sizes else value(dimensions))
    return message


def columns_of_tick():
    """Column name and (field, indices) of every number of a tick."""
    for _, field, sizes in fields_of("tick_t"):
        name = RENAMED.get(field, field)
        if not sizes:
            yield name, field, ()
        elif sizes == ["2"]:
            yield from ((f"{hand}_{name}", field, (h,)) for h, hand in enumerate(HANDS))
        elif sizes == ["3"]:
            yield from ((NUMBERED[field].format(i + 1), field, (i,)) for i in range(3))
        elif sizes == ["2", "3"]:
            quantity, unit, axes = VECTORS[field]  # a new vector needs an entry in VECTORS
            yield from ((f"{hand}_{quantity}_{axis}{unit}", field, (h, a)) for h, hand in enumerate(HANDS) for a, axis in enumerate(axes))
        else:
            raise AssertionError(f"{field} has another shape: {sizes}")


def at(message, field, indices):
    value = getattr(message, field)
    for i in indices:
        value = value[i]
    return value


def unit_of(column):
    return next((unit for ending, unit in UNITS if column.endswith(ending)), "")


class EveryField(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="fields-")
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        numbers = Numbers()
        cls.ticks = [fill(tick_t(), "tick_t", numbers, {}) for _ in range(TICKS)]
        cls.shapes = [fill(thread_t(), "thread_t", numbers, {"count": 3 + i}) for i in range(SHAPES)]
        cls.events = [fill(event_t(), "event_t", numbers, {}) for _ in range(EVENTS)]
        cls.status = fill(status_t(), "status_t", numbers, {})
        cls.status.session, cls.status.period_s, cls.status.max_force_N = SESSION, 0.004, 2.75
        for i, tick in enumerate(cls.ticks):
            tick.tick = 40 + i  # exports are sorted by tick number
        batch = tick_batch_t()
        batch.session, batch.count, batch.ticks = SESSION, TICKS, cls.ticks
        log = lcm.EventLog(str(cls.folder / "a.lcmlog"), "w", overwrite=True)
        for channel, message in (("STATUS", cls.status), ("TICKS", batch), *(("THREAD", s) for s in cls.shapes), *(("EVENT", e) for e in cls.events)):
            log.write_event(1_000_000, "LIGATURE_" + channel, message.encode())
        for note in NOTES:
            log.write_event(1_000_000, "LIGATURE_NOTES", note.encode())
        log.close()
        done = subprocess.run([HOST, "export", "a.lcmlog", "--ticks", "ticks.csv", "--forces", "forces.csv", "--shape", "shape.csv", "--hdf5", "a.h5", "--mcap", "a.mcap",
                               "--trace", "a.json"],
                              cwd=cls.folder, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        cls.columns = list(columns_of_tick())

    def table(self, name):
        with open(self.folder / name, newline="") as file:
            head, *rows = csv.reader(file)
        return {column: [float(row[i]) for row in rows] for i, column in enumerate(head)}

    def truth(self, field, indices):
        return [at(tick, field, indices) for tick in self.ticks]

    def test_no_two_fields_have_the_same_numbers(self):
        """Precondition of the other tests."""
        seen = [tuple(self.truth(field, indices)) for _, field, indices in self.columns]
        self.assertEqual(len(seen), len(set(seen)))

    def test_ticks_in_csv(self):
        table = self.table("ticks.csv")
        self.assertEqual(set(table), {name for name, _, _ in self.columns} | {"t_s", "session"})
        for name, field, indices in self.columns:
            self.assertEqual(table[name], self.truth(field, indices), name)
        self.assertEqual(table["t_s"], [tick.tick / 250 for tick in self.ticks])

    def test_forces_in_csv(self):
        table, known = self.table("forces.csv"), {name: (field, indices) for name, field, indices in self.columns}
        lengths = {f"{hand}_{force}_N" for hand in HANDS for force in ("device_f", "world_f")}
        for name, values in table.items():
            if name in known:
                self.assertEqual(values, self.truth(*known[name]), name)
            elif name in lengths:
                squares = [sum(x * x for x in xyz) for xyz in zip(*(table[name.removesuffix("_N") + f"_{axis}_N"] for axis in "xyz"))]
                for value, square in zip(values, squares):
                    self.assertAlmostEqual(value, square ** 0.5, delta=1e-12 * value)
            else:
                self.assertIn(name, ("t_s", "session"))

    def test_ticks_in_hdf5(self):
        with h5py.File(self.folder / "a.h5") as file:
            group = file["ticks"]
            self.assertEqual(set(group), {name for name, _, _ in self.columns} | {"t_s", "session"})
            for name, field, indices in self.columns:
                self.assertEqual(group[name][:].tolist(), self.truth(field, indices), name)

    def test_ticks_in_mcap(self):
        found = {}
        with open(self.folder / "a.mcap", "rb") as file:
            for _, channel, message in make_reader(file).iter_messages(topics=["/rig", "/left", "/right"]):
                prefix = "" if channel.topic == "/rig" else channel.topic[1:] + "_"
                for short, value in json.loads(message.data).items():
                    found.setdefault(prefix + short, []).append(value)
        self.assertEqual(set(found), {name for name, _, _ in self.columns} | {"session"})
        for name, field, indices in self.columns:
            self.assertEqual(found[name], self.truth(field, indices), name)

    def test_units_in_every_format(self):
        names = [name for name, _, _ in self.columns] + ["t_s"]
        words = {c["name"]: c.get("ligature:unit", "") for c in json.loads((self.folder / "ticks.csv-metadata.json").read_text())["tableSchema"]["columns"]}
        with h5py.File(self.folder / "a.h5") as file, open(self.folder / "a.mcap", "rb") as mcap:
            schemas = {s.name: json.loads(s.data)["properties"] for s in make_reader(mcap).get_summary().schemas.values()}
            for name in names:
                wanted = "ticks" if name == "tick" else unit_of(name)
                self.assertEqual(file["ticks"][name].attrs["unit"], wanted, name)
                self.assertEqual(words[name], wanted, name)
                hand = next((h for h in HANDS if name.startswith(h + "_")), None)
                if name != "t_s":
                    told = schemas[f"ligature.{hand or 'rig'}"][name.removeprefix(f"{hand}_")]["description"]
                    self.assertEqual(re.findall(r"\[([^\[]*)\]$", told), [wanted] if wanted else [], name)
            for name, dataset in file["shapes"].items():
                self.assertEqual(dataset.attrs["unit"], "ticks" if name == "tick" else unit_of(name), name)
            for name in file["events"]:
                self.assertEqual(file["events"][name].attrs["unit"], {"tick": "ticks", "t_s": "s"}.get(name, ""), name)

    def test_shapes(self):
        told = {field for _, field, _ in fields_of("thread_t")} - LEFT_OUT["thread_t"]
        with h5py.File(self.folder / "a.h5") as file:
            group = file["shapes"]
            self.assertEqual(set(group), told | {"t_s", "first"})
            first = 0
            for i, shape in enumerate(self.shapes):
                self.assertEqual([group[n][i] for n in ("tick", "count", "first", "radius_m")], [shape.tick, shape.count, first, shape.radius_m])
                self.assertEqual(group["t_s"][i], shape.tick / 250)
                part = slice(first, first + shape.count)
                for name in ("p_W_m", "tension_N", "turn_rad"):
                    self.assertEqual(group[name][part].tolist(), getattr(shape, name), name)
                first += shape.count
            self.assertEqual(group["p_W_m"].shape[0], first)
        table = self.table("shape.csv")
        self.assertEqual([list(p) for p in zip(table["x_m"], table["y_m"], table["z_m"])], [p for s in self.shapes for p in s.p_W_m])
        self.assertEqual(table["node"], [float(i) for s in self.shapes for i in range(s.count)])
        self.assertEqual(table["t_s"], [s.tick / 250 for s in self.shapes for _ in range(s.count)])
        with open(self.folder / "a.mcap", "rb") as mcap:
            drawn = [json.loads(m.data)["entities"][0]["lines"][0] for _, _, m in make_reader(mcap).iter_messages(topics=["/thread"])]
        self.assertEqual([[[p["x"], p["y"], p["z"]] for p in line["points"]] for line in drawn], [s.p_W_m for s in self.shapes])
        self.assertEqual([line["thickness"] for line in drawn], [2 * s.radius_m for s in self.shapes])

    def test_events(self):
        told = {field for _, field, _ in fields_of("event_t")} - LEFT_OUT["event_t"]
        truth = [{name: getattr(event, name) for name in told} for event in self.events]
        with h5py.File(self.folder / "a.h5") as file:
            group = file["events"]
            self.assertEqual(set(group), told | {"t_s"})
            columns = {name: group[name].asstr()[:].tolist() if name == "text" else group[name][:].tolist() for name in told}
            self.assertEqual([{name: columns[name][i] for name in told} for i in range(EVENTS)], truth)
            self.assertEqual(group["t_s"][:].tolist(), [e.tick / 250 for e in self.events])
        with open(self.folder / "a.mcap", "rb") as mcap:
            self.assertEqual([json.loads(m.data) for _, _, m in make_reader(mcap).iter_messages(topics=["/events"])], truth)

    def test_status(self):
        told = {field for _, field, _ in fields_of("status_t")} - LEFT_OUT["status_t"]
        self.assertEqual(told, {"firmware_version", "scene_file", "scene_toml", "period_s", "max_force_N", "scene_first_tick"}, "a new field: where is it told?")
        words = json.loads((self.folder / "ticks.csv-metadata.json").read_text())
        with h5py.File(self.folder / "a.h5") as file, open(self.folder / "a.mcap", "rb") as mcap:
            about = next(record.metadata for record in make_reader(mcap).iter_metadata() if record.name == "ligature")
            for name in told - {"scene_first_tick"}:
                truth = getattr(self.status, name)
                self.assertEqual(file.attrs[name], truth, name)
                self.assertEqual(words[f"ligature:{name}"], truth, name)
                self.assertEqual(about[name], str(truth), name)
            scenes = file["scenes"]
            self.assertEqual([scenes["file"].asstr()[0], scenes["toml"].asstr()[0], scenes["t_s"][0]],
                             [self.status.scene_file, self.status.scene_toml, self.status.scene_first_tick / 250])

    def test_notes_in_every_format(self):
        told = "\n".join(NOTES)
        for table in ("ticks", "forces", "shape"):
            self.assertEqual(json.loads((self.folder / f"{table}.csv-metadata.json").read_text())["ligature:notes"], told)
        self.assertEqual(json.loads((self.folder / "a.json").read_text())["otherData"]["notes"], told)
        with h5py.File(self.folder / "a.h5") as file, open(self.folder / "a.mcap", "rb") as mcap:
            self.assertEqual(file.attrs["notes"], told)
            about = next(record.metadata for record in make_reader(mcap).iter_metadata() if record.name == "ligature")
            self.assertEqual(about["notes"], told)


if __name__ == "__main__":
    unittest.main(verbosity=2)
