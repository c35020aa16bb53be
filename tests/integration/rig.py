"""The whole rig as processes on the `local:` bus, for tests: devices, firmware, recorder and an LCM listener.

Wall-clock time is not asserted: every wait is for a condition, with a limit that only ends a hang."""

import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(os.environ["LIGATURE_SOURCE"])
BIN = pathlib.Path(os.environ["LIGATURE_BIN"])
sys.path.insert(0, os.environ["LIGATURE_LCM_PYTHON"])

import lcm  # noqa: E402
from ligature_msg import status_t, tick_batch_t  # noqa: E402

HANDS = ("left", "right")
STATE_IDLE, STATE_ENGAGE, STATE_FORCE, STATE_FAULT = 2, 3, 4, 6
FLAG_PERIOD_LOST = 1
LCM_URL = "udpm://239.255.76.67:7667?ttl=0"


def run(program, *args, timeout=60):
    """Runs one of the project's programs to its end."""
    return subprocess.run([BIN / program, *map(str, args)], capture_output=True, text=True, timeout=timeout, cwd=ROOT)


class Listener(threading.Thread):
    """An LCM client that keeps the ticks and the last status that the firmware sent."""

    def __init__(self):
        super().__init__(daemon=True)
        self.ticks, self.status, self.stop = [], None, False
        self._lcm = lcm.LCM(LCM_URL)
        self._lcm.subscribe("LIGATURE_TICKS", self._on_ticks).set_queue_capacity(1000)
        self._lcm.subscribe("LIGATURE_STATUS", self._on_status)

    def _on_ticks(self, _, data):
        self.ticks.extend(tick_batch_t.decode(data).ticks)

    def _on_status(self, _, data):
        self.status = status_t.decode(data)

    def run(self):
        while not self.stop:
            try:
                self._lcm.handle_timeout(100)
            # Tests also send invalid data, which is ignored here. If a batch of the firmware were lost, tick numbers
            # would be missing.
            except (ValueError, struct.error):
                pass


class Rig:
    """Two devices, the firmware and optionally the recorder, as a context manager that ends all processes.

    The default watchdog is long, so that a stall of the machine is no fault; tests of the watchdog set their own."""

    def __init__(self, operator="scenes/operators/overhand.csv", scene="scenes/paper.toml", watchdog_ms=1000, record=False, extra=(),
                 prefix=(), flight=None):
        """@param prefix command that starts the firmware, e.g. ("taskset", "-c", "1"). @param flight file of the flight
        recorder, by default in the rig's folder."""
        self.folder = self.folder_of_its_own()
        self.path = pathlib.Path(self.folder.name)
        self.prefix, self.flight = list(prefix), flight or self.path / "flight.rec"
        self.operator, self.scene, self.watchdog_ms, self.with_recorder, self.extra = operator, scene, watchdog_ms, record, extra
        self.processes, self.listener = {}, Listener()
        bus = os.environ.get("LIGATURE_BUS", "")
        self.bus = dict(zip(HANDS, bus.split(","))) if bus else {h: f"local:{self.path / h}" for h in HANDS}

    @staticmethod
    def folder_of_its_own():
        return tempfile.TemporaryDirectory(prefix="rig-")

    def __enter__(self):
        self.listener.start()
        for hand in HANDS:
            self.start_device(hand)
        if self.with_recorder:
            self.start("recorder", "ligature-host", "record", "--out", self.log, "--flight-folder", self.path)
        self.start_firmware()
        return self

    @property
    def log(self):
        return self.path / "rig.lcmlog"

    def start(self, name, program, *args, prefix=()):
        with open(self.path / f"{name}.log", "a") as output:
            self.processes[name] = subprocess.Popen([*prefix, BIN / program, *map(str, args)], stdout=output, stderr=output, cwd=ROOT)

    def start_device(self, hand):
        self.start(hand, "ligature-device", "--hand", hand, "--bus", self.bus[hand], "--scene", self.scene,
                   "--operator", self.operator, "--stats", self.path / f"{hand}.json")

    def start_firmware(self):
        # A hand's energy account is debited for each lost period, even if the hand has not supplied any energy yet.
        # These tests need force on both hands at once; without the initial credit of 0.02 J, a machine that loses many
        # periods would never get there.
        self.start("firmware", "ligature-firmware", "run", "--scene", self.scene, "--left", self.bus["left"],
                   "--right", self.bus["right"], "--arm", "--watchdog-ms", self.watchdog_ms, "--recorder", self.flight, "--set", "hands.energy_credit_J=0.02", *self.extra,
                   *os.environ.get("LIGATURE_RIG_ARGS", "").split(), prefix=self.prefix)

    def kill(self, name):
        self.processes[name].send_signal(signal.SIGKILL)
        self.processes[name].wait()

    def end(self, name, how=signal.SIGTERM, bound_s=20):
        """Ends one process by a signal and returns its exit code; a hang is an error."""
        process = self.processes[name]
        if process.poll() is None:
            process.send_signal(how)
        return process.wait(timeout=bound_s)

    def alive(self, name):
        return self.processes[name].poll() is None

    def wait_for(self, condition, what, bound_s=30):
        """Waits until condition(self) holds."""
        end = time.monotonic() + bound_s
        while not condition(self):
            if time.monotonic() > end:
                raise AssertionError(f"{what} did not come within {bound_s} s\n{self.words()}")
            threading.Event().wait(0.01)

    def state_is(self, state):
        return bool(self.listener.ticks) and self.listener.ticks[-1].state == state

    def said(self, name):
        """Output of one process so far."""
        return (self.path / f"{name}.log").read_text()

    def device_stats(self, hand):
        """Ends a device and reads its statistics. The torque in them is the last one before the drives were switched
        off."""
        self.end(hand)
        return json.loads((self.path / f"{hand}.json").read_text())

    def jumped_in_a_stall(self):
        """Whether the firmware has ended with fault 18 after the machine stood still. A simulated hand follows its script by
        the clock: after a stall it moves on by several periods in one sample, which no hand could do."""
        said = self.said("firmware")
        return "fault 18" in said and re.search(r"deadline misses +[1-9]\d*  \(0 by the loop's own work\)", said) is not None

    def words(self):
        """Output of every process, for failure messages."""
        return "\n".join(f"--- {p.name}\n{p.read_text()[-2000:]}" for p in sorted(self.path.glob("*.log")))

    def __exit__(self, *_):
        for process in self.processes.values():
            if process.poll() is None:
                process.kill()
            process.wait()
        self.listener.stop = True
        self.listener.join()
        self.folder.cleanup()


class PageRig(Rig):
    """Its hands are moved by a page, or by whoever sends the messages of one."""

    def start_device(self, hand):
        self.start(hand, "ligature-device", "--hand", hand, "--bus", self.bus[hand], "--scene", self.scene, "--operator", "page", "--rt")
