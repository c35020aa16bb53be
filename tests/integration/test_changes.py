"""Another scene and other parameters while the rig runs: acknowledged or refused, through the real firmware."""

import unittest

from rig import Rig, STATE_ENGAGE, run

STATE_IDLE = 2


def send(*words):
    done = run("ligature-host", "send", *words)
    return done.returncode, done.stdout + done.stderr


class Changes(unittest.TestCase):
    def test_parameters_and_scenes(self):
        held = "; launch options hold: --set hands.energy_credit_J=0.02, --set hands.max_force_N=2.5"
        with Rig(extra=("--rt=warn", "--set", "hands.max_force_N=2.5")) as rig:
            rig.wait_for(lambda r: r.listener.ticks and r.listener.ticks[-1].state >= STATE_ENGAGE, "arming")
            self.assertEqual(send("set", "contact.friction", "0.5")[0], 0)
            code, said = send("set", "contact.friction", "9")
            self.assertEqual(code, 3)
            self.assertIn("found 9, allowed 0 .. 2", said)
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
            code, said = send("load-scene", "paper.toml suture.model=paper-2 suture.nodes=35")  # these come with a scene
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


if __name__ == "__main__":
    unittest.main()
