"""A run of the real programs, recorded over LCM and repeated by `ligature-lab rerun`, bit by bit; and how a rerun ends
early."""

import json
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

from rig import BIN, ROOT, Rig, STATE_FORCE, STATE_IDLE, run


PULL = """time,hand,x,y,z,grip
0.0,L,0.0,0.0,0.20,0
0.3,L,0.0,0.0,0.20,1
2.0,L,0.01,0.0,0.19,1
0.0,R,0.0,0.0,0.06,0
0.3,R,0.0,0.0,0.06,1
1.8,R,0.06,0.05,0.12,1
"""


def send(*words):
    done = run("ligature-host", "send", *words)
    assert done.returncode == 0, done.stdout + done.stderr


class Rerun(unittest.TestCase):
    def test_a_live_recording(self):
        """Records a run with force, a changed parameter, a reset and another scene. Then reruns it: it must be equal;
        with other settings it must differ; and SIGINT must end it."""
        with Rig(record=True, extra=("--rt=warn",)) as rig:
            rig.wait_for(lambda r: r.state_is(STATE_FORCE), "force")
            rig.wait_for(lambda r: max(r.listener.ticks[-1].grasped_node) >= 0, "a grasp")
            send("set", "contact.friction", "0.45")
            self.live_for(rig, 300)
            send("reset-thread")
            self.live_for(rig, 300)
            send("disarm")
            rig.wait_for(lambda r: r.state_is(STATE_IDLE), "idle")
            send("load-scene", "paper.toml suture.nodes=35")
            self.live_for(rig, 500)
            self.assertEqual(rig.end("firmware"), 0)
            self.assertEqual(rig.end("recorder", signal.SIGINT), 0, rig.words())
            last = rig.listener.ticks[-1]
            self.assertEqual((last.thread_resets, last.thread_parameters, last.thread_scenes), (1, 1, 1))
            scratch = tempfile.TemporaryDirectory(prefix="rerun-")
            self.addCleanup(scratch.cleanup)
            log = pathlib.Path(scratch.name) / "live.lcmlog"
            rig.log.rename(log)
        self.equal(log)
        self.other(log, pathlib.Path(scratch.name) / "other")
        self.interrupted(log, pathlib.Path(scratch.name) / "interrupted")

    def test_a_live_recording_of_a_suture(self):
        """The rod's contact budget depends on the machine; it is recorded, so that a rerun uses the same."""
        scratch = tempfile.TemporaryDirectory(prefix="rerun-")
        self.addCleanup(scratch.cleanup)
        hands = pathlib.Path(scratch.name) / "pull.csv"
        hands.write_text(PULL)
        with Rig(record=True, scene="scenes/suture-3-0.toml", operator=hands, extra=("--rt=warn",)) as rig:
            rig.wait_for(lambda r: r.listener.ticks and min(r.listener.ticks[-1].grasped_node) >= 0, "both hands' grasps")
            self.live_for(rig, 700)
            self.assertEqual(rig.end("firmware"), 0)
            self.assertEqual(rig.end("recorder", signal.SIGINT), 0, rig.words())
            self.assertIn("\n# --set suture.work_instructions=", rig.listener.status.scene_toml)
            self.equal(rig.log)

    def live_for(self, rig, ticks):
        until = rig.listener.ticks[-1].tick + ticks
        rig.wait_for(lambda r: r.listener.ticks[-1].tick >= until, f"tick {until}")

    def equal(self, log):
        done = run("ligature-lab", "rerun", log)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("equal        to the bit", done.stdout)
        self.assertNotIn("not known", done.stdout)

    def other(self, log, out):
        done = run("ligature-lab", "rerun", log, "--set", "suture.stretch_N=1500", "--out", out)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("different ", done.stdout)
        summary = json.loads((out / "summary.json").read_text())
        self.assertFalse(summary["equal"])
        self.assertEqual(summary["unknown_ticks"], 0)
        self.assertNotEqual(summary["recorded"]["right_rms_N"], summary["rerun"]["right_rms_N"])
        self.assertEqual({p.name for p in out.iterdir()} - {"rerun.png"}, {"rerun.lcmlog", "forces.csv", "shapes.csv", "summary.json"})
        report = run("ligature-host", "report", out / "rerun.lcmlog")
        self.assertEqual(report.returncode, 0, report.stderr)
        for wrong in ((log, "--set", "suture.nodes=1"), (log, "--session", 2), (out / "forces.csv",), (out / "rerun.lcmlog", "--out", out)):
            refused = run("ligature-lab", "rerun", *wrong)
            self.assertEqual(refused.returncode, 2, refused.stdout + refused.stderr)
            self.assertEqual(len(refused.stderr.splitlines()), 1, refused.stderr)

    def interrupted(self, log, out):
        slow = subprocess.Popen([BIN / "ligature-lab", "rerun", log, "--set", "time.substeps=300", "--out", out], cwd=ROOT,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + 60
        while not ((out / "rerun.lcmlog").exists() and (out / "rerun.lcmlog").stat().st_size > 0):
            self.assertIsNone(slow.poll(), "it was done before it could be interrupted")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)
        slow.send_signal(signal.SIGINT)
        said = slow.communicate(timeout=60)
        self.assertEqual(slow.returncode, 130, said)
        self.assertRegex(said[1], r"interrupted after \d+ of \d+ ticks")
        self.assertTrue(json.loads((out / "summary.json").read_text())["interrupted"])
        self.assertEqual(run("ligature-host", "export", out / "rerun.lcmlog", "--ticks", out / "ticks.csv").returncode, 0)


if __name__ == "__main__":
    unittest.main()
