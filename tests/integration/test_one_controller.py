"""A bus has one controller. When two start at the same time as real processes, at most one runs, undisturbed; a refused
one ends with exit code 3 and one line. On one machine a lock decides, which a controller takes before its first frame.
Two network namespaces stand for two machines on one cable: the lock does not reach across them, so each controller
listens on the bus for the other."""

import random
import unittest

from bare_rig import ROOT, BareRig, pause
from seeds import shifted

APART_MS = (0, 1, 3, 10, 30)


class OneController(BareRig):
    def outcome(self, controllers):
        """Exit codes of the controllers, and the messages of the refused ones. A controller that ran must have had no
        fault."""
        ended = [(c, *c.communicate(timeout=120)) for c in controllers]
        refused = []
        for controller, _, wrong in ended:
            self.assertIn(controller.returncode, (0, 3), wrong)
            self.assertNotIn("fault", wrong)
            if controller.returncode == 0:
                continue
            lines = [line for line in wrong.splitlines() if line.startswith("ligature-firmware: ")]
            self.assertEqual(len(lines), 1, wrong)
            self.assertIn("another controller", lines[0])
            self.assertIn("remedy: ", lines[0])
            refused.append(lines[0])
        return sorted(c.returncode for c in controllers), refused

    def test_on_one_machine_exactly_one_runs(self):
        for apart_ms in APART_MS:
            first = self.start()
            pause(apart_ms * 1e-3)
            codes, refused = self.outcome([first, self.start()])
            self.assertEqual(codes, [0, 3], apart_ms)
            self.assertIn("(process ", refused[0])

    def test_one_shared_bus_is_enough(self):
        other = self.start_device("right", self.path / "other")
        alias = self.path / "alias"
        alias.symlink_to(self.path / "left")
        codes, refused = self.outcome([self.start(duration=2), self.start((f"local:{alias}", other))])
        self.assertIn(codes, ([0, 0], [0, 3]), "both only if the machine put them one after the other")
        for line in refused:
            self.assertIn("bus 'local:", line)

    def test_a_bus_is_free_again_when_its_controller_was_killed(self):
        first = self.start(duration=60)
        pause(random.Random(shifted(50)).uniform(0.0, 1.0))
        first.kill()
        first.wait()
        codes, _ = self.outcome([self.start()])
        self.assertEqual(codes, [0])

    def test_on_two_machines_at_most_one_runs(self):
        apart = (ROOT / "scripts/private-net",)
        for apart_ms in APART_MS:
            first = self.start(prefix=apart)
            pause(apart_ms * 1e-3)
            codes, refused = self.outcome([first, self.start(prefix=apart)])
            self.assertIn(codes, ([0, 3], [3, 3]), apart_ms)
            for line in refused:
                self.assertIn("another controller is on this bus", line)


if __name__ == "__main__":
    unittest.main(verbosity=2)
