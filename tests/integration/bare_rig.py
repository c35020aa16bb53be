"""Two hands and a controller as processes on the `local:` bus, without LCM, for tests of the controller's start and
operation.

Wall-clock time is not asserted: every wait is for a condition, with a limit that only ends a hang."""

import os
import pathlib
import subprocess
import tempfile
import threading
import time
import unittest

ROOT = pathlib.Path(os.environ["LIGATURE_SOURCE"])
BIN = pathlib.Path(os.environ["LIGATURE_BIN"])


def pause(seconds):
    threading.Event().wait(seconds)


class BareRig(unittest.TestCase):
    """Base class of tests: starts the processes, and ends them all after each test."""

    def setUp(self):
        self.path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bare-")))
        self.buses = {hand: self.start_device(hand, self.path / hand) for hand in ("left", "right")}

    def started(self, command, **how):
        process = subprocess.Popen([*map(str, command)], cwd=ROOT, **how)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def start_device(self, hand, path):
        with open(f"{path}.log", "w") as log:
            self.started([BIN / "ligature-device", "--hand", hand, "--bus", f"local:{path}", "--scene", "scenes/paper.toml"], stdout=log, stderr=log)
        return f"local:{path}"

    def start(self, buses=None, prefix=(), duration=0.4, rt="off"):
        left, right = buses or (self.buses["left"], self.buses["right"])
        return self.started([*prefix, BIN / "ligature-firmware", "run", "--scene", "scenes/paper.toml", "--left", left, "--right", right,
                             "--no-telemetry", "--rt", rt, "--force", "--recorder", self.path / "flight.rec", "--recorder-s", 5,
                             "--watchdog-ms", 2000, "--exit-on-fault", "--duration", duration],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for(self, condition, what, bound_s=60):
        end = time.monotonic() + bound_s
        while not (found := condition()):
            if time.monotonic() > end:
                raise AssertionError(f"{what} did not come within {bound_s} s")
            pause(0.02)
        return found
