"""The form real of ligature.rig: pytest watches a running rig of processes and asks a person to move the devices. The
person is a thread here that reads the terminal and moves the simulated devices.

    dry_rig.py FOLDER_OF_PROGRAMS FIRMWARE_OPTIONS"""

import os
import pathlib
import re
import subprocess
import sys
import time
import unittest

import lcm

import ligature
from ligature import rig
from ligature.rig.live import Live
from ligature.rig.network import URL

LIFT = pathlib.Path(os.environ["LIGATURE_SOURCE"]) / "examples/rig/test_lift.py"
ASKED = re.compile(r"(left|right) hand: tip to \(([^)]*)\) m, jaws (closed|open)")
PYTEST = [sys.executable, "-u", "-m", "pytest", "-s", "-q", "-p", "no:cacheprovider", "--ligature-rig", "real"]


class Dry(unittest.TestCase):
    def setUp(self):
        rig.use("live", *PROGRAMS)
        self.live = Live(ligature.Scene.load(ligature.SCENES / "paper.toml"), {})
        self.live.start()
        self.addCleanup(self.live.close)
        self.commands, self.lcm = [], lcm.LCM(URL)
        heard = self.lcm.subscribe("LIGATURE_COMMAND", lambda _, data: self.commands.append(data))
        self.addCleanup(self.lcm.unsubscribe, heard)

    def watched(self, on_request):
        """Runs the lift on this rig in dry form. @returns pytest's exit code, and what it printed."""
        said = []
        with subprocess.Popen([*PYTEST, LIFT], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child:
            for line in child.stdout:
                said.append(line)
                if asked := ASKED.search(line):
                    side, place, jaws = asked.groups()
                    on_request(("left", "right").index(side), tuple(map(float, place.split(","))), jaws == "closed")
            code = child.wait(timeout=60)
        while self.lcm.handle_timeout(0) > 0:
            pass
        return code, "".join(said)

    def follow(self, hand, place, closed):
        self.live.wish(hand, place, False, closed)

    def test_a_lift_by_a_person_passes_without_a_command_or_a_torque(self):
        code, said = self.watched(self.follow)
        self.assertEqual(code, 0, said)
        self.assertEqual(len(ASKED.findall(said)), 3, said)
        self.assertEqual(self.commands, [])
        ticks = self.live.ticks()
        self.assertGreater(len(ticks["tick"]), 1000)
        self.assertGreaterEqual(ticks["left_node"].max(), 0, "the person gripped the thread")
        self.assertFalse(any(ticks[f"{side}_torque_{joint}_permille"].any() for side in ("left", "right") for joint in (1, 2, 3)))

    def test_the_test_ends_when_somebody_arms_the_rig(self):
        def follow_and_arm(hand, place, closed):
            self.live.command("arm")
            self.follow(hand, place, closed)

        code, said = self.watched(follow_and_arm)
        self.assertEqual(code, 1, said)
        self.assertIn("somebody has armed it, and this form tests without force", said)

    def test_another_scene_than_the_rig_s_is_refused(self):
        rig.use("real")
        with self.assertRaisesRegex(ligature.Refusal, "found paper.toml on the rig, allowed desk.toml"):
            rig.Rig("desk.toml").__enter__()

    def test_no_rig_is_said_to_be_none(self):
        self.live.close()
        time.sleep(0.5)
        rig.use("real")
        with self.assertRaisesRegex(rig.Expected, "no status has come within 5 s"):
            rig.Rig("paper.toml").__enter__()


if __name__ == "__main__":
    PROGRAMS = sys.argv[1], sys.argv[2].split()
    unittest.main(argv=sys.argv[:1], verbosity=2)
