"""Changes of scene and parameters during a run, accepted or rejected by the real firmware."""

import os
import pathlib
import tempfile
import threading
import unittest

from rig import ROOT, Rig, STATE_ENGAGE, STATE_FORCE, STATE_IDLE, run


def send(*words):
    done = run("ligature-host", "send", *words)
    return done.returncode, done.stdout + done.stderr


class Changes(unittest.TestCase):
    def test_parameters_and_scenes(self):
        held = "; launch options hold: --set hands.energy_credit_J=0.02, --set hands.max_force_N=2.5"
        with Rig(extra=("--rt=warn", "--set", "hands.max_force_N=2.5")) as rig:
            rig.wait_for(lambda r: r.listener.ticks and r.listener.ticks[-1].state >= STATE_ENGAGE, "arming")
            self.assertEqual(send("set", "contact.friction", "0.5")[0], 0)
            code, said = send("set", "contact.friction", "11")
            self.assertEqual(code, 3)
            self.assertIn("found 11, allowed 0 .. 10", said)
            code, said = send("load-scene", "desk.toml")
            self.assertEqual(code, 3)
            self.assertIn("disarm first", said)

            self.assertEqual(send("disarm")[0], 0)
            rig.wait_for(lambda r: r.state_is(STATE_IDLE), "idle")
            code, said = send("load-scene", "../README.md")
            self.assertEqual(code, 3)
            self.assertIn("allowed desk.toml", said)
            code, said = send("load-scene", "desk.toml")
            self.assertEqual((code, said), (0, f"load-scene accepted: scene desk.toml loaded{held}\n"))
            rig.wait_for(lambda r: r.listener.status.scene_file.endswith("desk.toml"), "the new scene's name")
            self.assertEqual(rig.listener.status.max_force_N, 2.5)
            # The thread model and the number of nodes can only be changed by loading a scene.
            code, said = send("load-scene", "paper.toml suture.model=paper-2 suture.nodes=35")
            self.assertEqual((code, said), (0, f"load-scene accepted: scene paper.toml loaded with suture.model=paper-2 suture.nodes=35{held}\n"))
            rig.wait_for(lambda r: "suture.model=paper-2" in r.listener.status.scene_toml, "the model in the scene's text")
            code, said = send("load-scene", "paper.toml suture.model=rubber")
            self.assertEqual(code, 3)
            self.assertIn("paper-1", said)
            code, said = send("load-scene", "paper.toml time.tick_s=1")
            self.assertEqual(code, 3)
            self.assertIn("allowed suture.model=MODEL and suture.nodes=N", said)
            tick = rig.listener.ticks[-1]
            self.assertEqual((tick.state, tick.fault), (STATE_IDLE, 0))
            self.assertEqual(rig.end("firmware"), 0)

    def test_scenes_that_would_kill_or_hang_the_controller(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        os.mkfifo(path / "pipe")
        os.mkfifo(path / "pipe.toml")
        poison = {
            "deep.toml": ("a." * 500_000 + "a = 1", "nested too deep"),
            "thin.toml": ("radius_m = 1e-300", "found 1e-300, allowed number 1e-06 .. 100"),
            "short.toml": ("length_m = 5e-324", "allowed number 0.001 .. 1000"),
            "light.toml": ("node_mass_kg = 1e-300", "allowed number 1e-09 .. 10000"),
            "waits.toml": ('initial = "pipe"', "found a pipe or device"),
            "slow.toml": ("nodes = 5000\n[time]\nsubsteps = 400", "slow.toml: the rehearsal "),
        }
        for name, (line, _) in poison.items():
            (path / name).write_text(f"[suture]\n{line}\n")
        (path / "good.toml").write_text((ROOT / "scenes/paper.toml").read_text())
        with Rig(scene=path / "good.toml") as rig:
            rig.wait_for(lambda r: r.listener.ticks and r.listener.ticks[-1].state >= STATE_ENGAGE, "arming")
            self.assertEqual(send("disarm")[0], 0)
            rig.wait_for(lambda r: r.state_is(STATE_IDLE), "idle")
            for name, (_, words) in poison.items():
                with self.subTest(scene=name):
                    code, said = send("load-scene", name)
                    self.assertEqual(code, 3)
                    self.assertIn(words, said)
            self.assertEqual(send("load-scene", "pipe.toml")[0], 3)
            code, said = send("load-scene", "good.toml")
            self.assertEqual(code, 0, said)
            self.assertEqual((rig.listener.ticks[-1].state, rig.listener.ticks[-1].fault), (STATE_IDLE, 0))
            self.assertEqual(rig.end("firmware"), 0)

    def test_nothing_else_on_the_loops_core(self):
        """During live changes, with and without force, no other thread of the firmware or its children may run on the
        loop's core, whatever it measures or builds."""
        with Rig(extra=("--rt=warn",)) as rig:
            rig.wait_for(lambda r: r.state_is(STATE_FORCE), "force")
            pid = rig.processes["firmware"].pid
            core = loops_core()
            quiet = allowed_on(core, pid)
            self.assertIn(len(quiet), (1, 2), f"the loop, and the thread's physics, on core {core}")
            watch = CoreWatch(core, pid)
            for i in range(10):
                self.assertEqual(send("set", "contact.friction", f"{0.3 + 0.01 * i}")[0], 0)
            self.assertEqual(send("disarm")[0], 0)
            rig.wait_for(lambda r: r.state_is(STATE_IDLE), "idle")
            for name in ("desk.toml", "suture-3-0.toml"):  # the second measures its contact budget at once
                self.assertEqual(send("load-scene", name)[0], 0)
            seen, children = watch.end()
            self.assertEqual(seen - quiet, set(), "others were allowed on the loop's core")
            self.assertGreater(children, 0, "the rehearsals were not seen at all")
            self.assertEqual(rig.end("firmware"), 0)


def loops_core():
    """The core that firmware/platform/realtime.cpp chooses."""
    isolated = pathlib.Path("/sys/devices/system/cpu/isolated").read_text().strip()
    return int(isolated.replace("-", ",").split(",")[-1]) if isolated else max(os.sched_getaffinity(0))


def tasks_of(pid):
    return [int(t.name) for t in pathlib.Path(f"/proc/{pid}/task").iterdir()]


def children_of(pid):
    return [int(c) for t in tasks_of(pid) for c in pathlib.Path(f"/proc/{pid}/task/{t}/children").read_text().split()]


def allowed_on(core, pid):
    """The threads of a process that may run on that core; none if the process has ended."""
    found = set()
    for task in tasks_of(pid):
        try:
            if core in os.sched_getaffinity(task):
                found.add(task)
        except ProcessLookupError:
            pass
    return found


class CoreWatch(threading.Thread):
    """Checks every millisecond which threads of a process and its children may run on a core."""

    def __init__(self, core, pid):
        super().__init__(daemon=True)
        self.core, self.pid, self.seen, self.children, self.over = core, pid, set(), set(), threading.Event()
        self.start()

    def run(self):
        while not self.over.wait(0.001):
            self.seen |= allowed_on(self.core, self.pid)
            try:
                for child in children_of(self.pid):
                    self.seen |= allowed_on(self.core, child)
                    self.children.add(child)
            except (FileNotFoundError, ProcessLookupError):  # ended in the meantime
                pass

    def end(self):
        self.over.set()
        self.join()
        return self.seen, len(self.children)


if __name__ == "__main__":
    unittest.main()
