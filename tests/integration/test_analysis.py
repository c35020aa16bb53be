"""The examples of docs/analysis.md run, and every export format holds the messages' numbers exactly."""

import json
import os
import pathlib
import random
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
import numpy as np  # noqa: E402
from ligature_msg import event_t, status_t, thread_t, tick_batch_t, tick_t  # noqa: E402
from mcap.reader import NonSeekingReader, SeekingReader, make_reader  # noqa: E402
from seeds import shifted  # noqa: E402

TICKS, SCENE, OTHER = 4321, "[suture]\nnodes = 4\n", "[suture]\nnodes = 6\n"


def awkward(rng):
    """A double with many significant digits."""
    return rng.uniform(-4.0, 4.0) * 10.0 ** rng.randint(-12, 3)


def ticks():
    rng = random.Random(shifted(6))
    for number in range(TICKS):
        tick = tick_t()
        tick.tick, tick.state, tick.grasped_node = number, 4, [3, -1]
        for field in (tick.f_device_N, tick.f_world_N, tick.p_WT_m, tick.v_WT_m_per_s, tick.q_rad):
            for hand in range(2):
                field[hand] = [awkward(rng) for _ in range(3)]
        tick.potential_J, tick.port_energy_J, tick.min_gap_m = awkward(rng), [awkward(rng), awkward(rng)], awkward(rng)
        tick.bus_load, tick.scheduled_ns, tick.flags = [0.625, 0.7], (1 << 53) + number, 2 if number == 7 else 0
        yield tick


def write_log(path):
    log = lcm.EventLog(str(path), "w", overwrite=True)
    batch = tick_batch_t()
    batch.session = 1

    def say(channel, message, at):
        log.write_event(1_000_000 + at * 1000, "LIGATURE_" + channel, message.encode())

    def status(toml, at):
        message = status_t()
        message.session, message.period_s, message.max_force_N, message.tick = 1, 1e-3, 3.3, at
        message.scene_first_tick = at
        message.scene_file, message.scene_toml, message.firmware_version = "scenes/two.toml", toml, "0.1.0"
        say("STATUS", message, at)

    everything = list(ticks())
    status(SCENE, 0)
    for start in range(0, TICKS, 20):
        batch.ticks = everything[start:start + 20]
        batch.count = len(batch.ticks)
        say("TICKS", batch, start)
        if start == 2000:
            status(OTHER, start)
        thread = thread_t()
        thread.tick, thread.radius_m, thread.count = start, 0.05, 4 if start < 2000 else 6
        thread.p_W_m = [[0.1 * i, 0.0, 0.5] for i in range(thread.count)]
        thread.tension_N, thread.turn_rad = [0.5] * thread.count, [0.0] * thread.count
        say("THREAD", thread, start)
    event = event_t()
    event.tick, event.kind, event.hand, event.code, event.text = 2000, 6, -1, 0, "scene two.toml loaded"
    say("EVENT", event, TICKS)
    log.close()
    return everything


class Analysis(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="analysis-")
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.ticks = write_log(cls.folder / "knot.lcmlog")
        subprocess.run([HOST, "export", "knot.lcmlog", "--forces", "forces.csv", "--ticks", "ticks.csv", "--shape", "shape.csv",
                        "--hdf5", "knot.h5", "--mcap", "knot.mcap"], cwd=cls.folder, check=True, capture_output=True)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_the_examples_of_the_page_run(self):
        examples = re.findall(r"```python\n(.*?)```", (ROOT / "docs/analysis.md").read_text(), re.S)
        self.assertEqual(len(examples), 5)
        environment = {**os.environ, "PYTHONPATH": os.environ["LIGATURE_LCM_PYTHON"]}
        said = [subprocess.run([sys.executable, "-c", code], cwd=self.folder, env=environment, check=True, capture_output=True, text=True).stdout
                for code in examples]
        self.assertIn("scenes/two.toml", said[0])
        self.assertIn(f"{TICKS} ticks", said[1])
        self.assertIn("last shape: 6 nodes", said[1])
        self.assertIn("2000 scene two.toml loaded", said[1])
        self.assertIn("firmware 0.1.0", said[2])
        self.assertIn("tick 0 was at", said[3])
        self.assertIn("[suture]", said[4])

    def test_a_picture_of_the_thread_even_of_one_without_a_knot(self):
        def plot(*words):
            return subprocess.run([HOST, "plot", "knot.lcmlog", *words], cwd=self.folder, capture_output=True, text=True)
        drawn = plot("--thread", "--out", "thread.svg")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertIn("0_1", (self.folder / "thread.svg").read_text(), "the title names the knot")
        self.assertEqual(plot("--thread", "--frames", "--out", "no.svg").returncode, 2)
        self.assertFalse((self.folder / "no.svg").exists())

    def columns(self):
        """Names and values of a tick's columns, from the message itself."""
        axes = "xyz"
        for hand, name in enumerate(("left", "right")):
            for field, quantity, unit in (("p_WT_m", "p_WT", "_m"), ("f_device_N", "device_f", "_N"), ("f_world_N", "world_f", "_N")):
                for axis in range(3):
                    yield f"{name}_{quantity}_{axes[axis]}{unit}", lambda t, f=field, h=hand, a=axis: getattr(t, f)[h][a]
            yield f"{name}_port_energy_J", lambda t, h=hand: t.port_energy_J[h]
            yield f"{name}_node", lambda t, h=hand: t.grasped_node[h]
        for name in ("tick", "scheduled_ns", "flags", "state", "potential_J", "min_gap_m"):
            yield name, lambda t, n=name: getattr(t, n)

    def test_throws_that_lie_apart_are_magnified_one_by_one(self):
        sys.path.insert(0, str(ROOT / "host/plots"))
        from plot_thread import knotted
        angle = np.linspace(0.0, 2.0 * np.pi, 200)
        loop = np.stack([10.0 * np.sin(angle), 10.0 - 10.0 * np.cos(angle), np.linspace(0.0, 1.0, 200)], axis=1)  # touches at its foot
        straight = np.stack([np.linspace(0.5, 100.0, 200), np.zeros(200), np.ones(200)], axis=1)
        for throws in (0, 1, 2, 3):
            line = [straight - [100.0, 0.0, 1.0]]
            for k in range(throws):
                line += [loop + [100.0 * k, 0.0, k], straight + [100.0 * k, 0.0, k]]
            points = np.concatenate(line)
            along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
            parts = knotted(points, along, 1.0)
            self.assertEqual(len(parts), max(1, throws))
            for k, (first, last) in enumerate(parts if throws else []):
                self.assertLess(np.linalg.norm(points[first:last + 1].mean(axis=0) - loop.mean(axis=0) - [100.0 * k, 0.0, k]), 1.0)

    def test_hdf5_and_csv_hold_the_messages_to_the_last_bit(self):
        head, *lines = (self.folder / "ticks.csv").read_text().strip().split("\n")
        place = {name: i for i, name in enumerate(head.split(","))}
        rows = [line.split(",") for line in lines]
        with h5py.File(self.folder / "knot.h5") as file:
            group = file["ticks"]
            self.assertEqual(set(group), set(place))
            for name, value in self.columns():
                truth = [value(t) for t in self.ticks]
                self.assertEqual(group[name][:].tolist(), truth, name)
                self.assertEqual([type(truth[0])(row[place[name]]) for row in rows], truth, name)
            for name in group:
                self.assertTrue(group[name].attrs["meaning"], name)
            self.assertEqual(file.attrs["scene_toml"], SCENE)
            self.assertEqual(file["scenes"]["toml"].asstr()[:].tolist(), [SCENE, OTHER])

    def test_mcap_holds_them_too(self):
        with open(self.folder / "knot.mcap", "rb") as file:
            reader = make_reader(file)
            left = [json.loads(m.data) for _, _, m in reader.iter_messages(topics=["/left"])]
            self.assertEqual([m["device_f_x_N"] for m in left], [t.f_device_N[0][0] for t in self.ticks])
            rig = [json.loads(m.data) for _, _, m in reader.iter_messages(topics=["/rig"])]
            self.assertEqual([m["potential_J"] for m in rig], [t.potential_J for t in self.ticks])
            attached = {a.name: a.data.decode() for a in reader.iter_attachments()}
            self.assertEqual(attached, {"scene-1.toml": SCENE, "scene-2.toml": OTHER})

    def test_mcap_is_the_same_by_its_index_and_from_front_to_back(self):
        path = self.folder / "knot.mcap"
        with open(path, "rb") as file, open(path, "rb") as stream:
            reader = SeekingReader(file, validate_crcs=True)
            summary = reader.get_summary()
            by_index = [(c.topic, m.log_time, m.sequence, m.data) for _, c, m in reader.iter_messages()]
            in_order = [(c.topic, m.log_time, m.sequence, m.data) for _, c, m in NonSeekingReader(stream, validate_crcs=True).iter_messages(log_time_order=False)]
        self.assertEqual(sorted(by_index), sorted(in_order))
        counts = {summary.channels[channel].topic: count for channel, count in summary.statistics.channel_message_counts.items()}
        self.assertEqual(counts, {"/rig": TICKS, "/left": TICKS, "/right": TICKS, "/thread": -(-TICKS // 20), "/events": 1})
        self.assertEqual(summary.statistics.message_count, len(in_order))
        self.assertEqual(summary.statistics.chunk_count, len(summary.chunk_indexes))
        self.assertGreater(len(summary.chunk_indexes), 1)
        self.assertEqual((summary.statistics.message_start_time, summary.statistics.message_end_time), (0, (TICKS - 1) * 1_000_000))
        with open(path, "rb") as file:  # a span of time, found by the index
            some = [m.log_time for _, _, m in SeekingReader(file).iter_messages(topics=["/rig"], starting_at=1_000_000_000, ending_before=1_100_000_000)]
        self.assertEqual(some, [i * 1_000_000 for i in range(1000, 1100)])

    def test_every_csv_explains_every_column(self):
        for name in ("forces", "ticks", "shape"):
            about = json.loads((self.folder / f"{name}.csv-metadata.json").read_text())
            head = (self.folder / f"{name}.csv").read_text().split("\n", 1)[0].split(",")
            self.assertEqual([c["name"] for c in about["tableSchema"]["columns"]], head)
            self.assertTrue(all(c["dc:description"] for c in about["tableSchema"]["columns"]))
            self.assertEqual(about["ligature:scene_toml"], SCENE)

    def test_comparing_a_recording_with_itself_finds_nothing(self):
        done = subprocess.run([HOST, "compare", "knot.lcmlog", "knot.lcmlog", "--out", "c.svg"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("root mean square 0.0000 N, largest 0.0000 N"), 2)
        self.assertIn("[suture]", (self.folder / "c.svg").read_text())  # the scene is embedded in the picture

    def test_nothing_is_left_of_a_refused_export(self):
        (self.folder / "bad.lcmlog").write_bytes(b"no log")
        done = subprocess.run([HOST, "export", "bad.lcmlog", "--hdf5", "x.h5", "--mcap", "x.mcap"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertEqual([p.name for p in self.folder.glob("x.*")], [])


if __name__ == "__main__":
    unittest.main()
