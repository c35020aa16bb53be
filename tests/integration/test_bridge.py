"""ligature-bridge between the firmware and simulated Inverse Services: brought up, felt, stopped.

Wall-clock time is not asserted. Silence and watchdogs are long, so that a stall of the machine is no fault. The bridges
exchange 250 messages a second, because both simulated services share one interpreter with the test."""

import json
import os
import pathlib
import subprocess
import tempfile
import threading
import time
import unittest

from inverse_service import InverseService
from rig import BIN, HANDS, ROOT, STATE_ENGAGE, STATE_FAULT, STATE_FORCE, Rig, run

RECORD = "scenes/devices/inverse3.toml"
FAULT_BUS_LOST, FAULT_SAMPLES_TOO_OLD, FAULT_ENCODER_FROZEN = 10, 11, 22


class BridgedRig(Rig):
    """Both hands are Inverse3 devices of a simulated service each. Their record allows a long delay, because the services
    share an interpreter with the test."""

    def __init__(self, **how):
        self.services = {hand: InverseService(device_id=f"04{i}D") for i, hand in enumerate(HANDS)}
        self.record_folder = tempfile.TemporaryDirectory(prefix="bridge-")
        self.record = pathlib.Path(self.record_folder.name) / "slow.toml"
        text = (ROOT / RECORD).read_text()
        assert text.count("value = 0.0025") == 1
        self.record.write_text(text.replace("value = 0.0025", "value = 0.5"))
        super().__init__(extra=("--device", self.record, "--override-passivity", *how.pop("extra", ())), **how)

    def start_device(self, hand):
        service = self.services[hand]
        self.start(hand, "ligature-bridge", "--bus", self.bus[hand], "--device", self.record, "--haply", service.url, "--id", service.device_id,
                   "--silence-ms", 1000, "--rate", 250, "--stats", self.path / f"{hand}.json")

    def press(self, **buttons):
        for service in self.services.values():
            service.press(**buttons)

    def circle(self, until, radius_m=0.02):
        """Moves both hands, as fast as the service is asked, until a condition holds."""
        began = time.monotonic()
        while not until():
            t = time.monotonic() - began
            if t > 60:
                raise AssertionError(f"never came\n{self.words()}")
            shift = radius_m * min(1.0, t) * (1 if int(t) % 2 == 0 else 1 - 2 * abs(t % 1 - 0.5))
            for sign, service in zip((-1, 1), self.services.values()):
                service.position[0] = sign * shift
            threading.Event().wait(0.001)

    def __exit__(self, *why):
        super().__exit__(*why)
        for service in self.services.values():
            service.stop()
        self.record_folder.cleanup()


def is_zero(service):
    return service.force == (0.0, 0.0, 0.0)


def ticks_to_zero(ticks, hand):
    """Ticks from the last one with the dead-man pressed until the torque of the hand is zero."""
    pressed = max(i for i, t in enumerate(ticks) if t.dead_man[hand])
    return max(t.tick - ticks[pressed].tick for t in ticks[pressed:] if any(t.torque_permille[hand])) + 1


class Bridge(unittest.TestCase):
    def up(self, rig):
        rig.wait_for(lambda r: r.state_is(STATE_ENGAGE), "the drives of the bridge, enabled and armed")

    def feel(self, rig):
        """Holds a node of the thread with both hands, and pulls until a force arrives at both devices."""
        self.up(rig)
        rig.press(a=True)
        rig.wait_for(lambda r: r.state_is(STATE_FORCE), "FORCE")
        rig.press(b=True)
        rig.circle(lambda: all(service.peak > 0.05 for service in rig.services.values()))

    def test_a_force_arrives_at_the_device_and_ends_with_the_dead_man(self):
        with BridgedRig() as rig:
            self.feel(rig)
            for service in rig.services.values():
                self.assertEqual(service.complaints, [])
                self.assertLessEqual(service.peak, 3.3 + 0.01)
            rig.press(a=False)
            rig.wait_for(lambda r: all(map(is_zero, r.services.values())), "zero force after the dead-man")
            rig.wait_for(lambda r: not r.state_is(STATE_FORCE), "the end of FORCE")
            self.assertEqual(rig.listener.ticks[-1].fault, 0)
            zero = [ticks_to_zero(list(rig.listener.ticks), hand) for hand in range(2)]
            print(f"  zero torque {zero} ticks after the dead-man", flush=True)
            self.assertLessEqual(max(zero), 100)
            stats = rig.device_stats("left")
            print(f"  age of a state at SYNC: mean {stats['mean_state_age_us']:.0f} us, worst {stats['worst_state_age_us']:.0f} us; "
                  f"longest exchange {stats['longest_exchange_us']:.0f} us; wait of a force: mean {stats['mean_force_wait_us']:.0f} us, "
                  f"worst {stats['worst_force_wait_us']:.0f} us of {stats['forces']}", flush=True)
            self.assertGreater(stats["forces"], 0)
            self.assertEqual(stats["syncs_while_silent"], 0)

    def test_positions_and_buttons_are_those_of_the_device(self):
        rig = BridgedRig()
        service = rig.services["right"]
        service.position[:] = [0.05, -0.10, 0.16]
        with rig:
            self.up(rig)
            service.press(b=True)
            wanted = [(p - home) / 0.02 for p, home in zip(service.position, (0.0, -0.12, 0.15))]
            rig.wait_for(lambda r: max(abs(q - w) for q, w in zip(r.listener.ticks[-1].q_rad[1], wanted)) < 1e-4, "the position in joint angles")
            rig.wait_for(lambda r: r.listener.ticks[-1].grip[1] == 1 and r.listener.ticks[-1].dead_man[1] == 0, "the buttons")

    def test_a_silent_device_is_a_fault_without_force_and_comes_back(self):
        with BridgedRig() as rig:
            self.feel(rig)
            rig.services["left"].silent = True
            rig.wait_for(lambda r: r.state_is(STATE_FAULT), "FAULT")
            # The hands of this test stop abruptly, and the slow record repeats a state for half a second: that may look
            # like an encoder that stands still, before the samples are missing.
            self.assertIn(rig.listener.ticks[-1].fault, (FAULT_SAMPLES_TOO_OLD, FAULT_ENCODER_FROZEN), rig.words())
            rig.wait_for(lambda r: is_zero(r.services["right"]), "zero force at the other device")
            rig.wait_for(lambda r: "the device is silent: drives off" in r.said("left"), "what the bridge says")
            rig.services["left"].silent = False
            rig.wait_for(lambda r: r.said("left").count("the device answers") == 2, "the device again")
            rig.wait_for(lambda r: is_zero(r.services["left"]), "zero force at the device that is back")

    def test_a_late_answer_ends_with_a_zero_force(self):
        """The service reads on when it is no longer late; the last force on the connection must be zero."""
        with BridgedRig() as rig:
            self.feel(rig)
            service = rig.services["left"]
            before = len(service.left_behind)
            service.late_s = 1.5
            rig.wait_for(lambda r: "the device is silent: drives off" in r.said("left"), "what the bridge says")
            service.late_s = 0.0
            rig.wait_for(lambda r: len(service.left_behind) > before, "the end of the connection")
            self.assertEqual(service.left_behind[before], (0.0, 0.0, 0.0))

    def test_a_lost_connection_is_opened_again_without_force(self):
        with BridgedRig() as rig:
            self.feel(rig)
            rig.services["left"].drop_clients()
            rig.press(a=False)
            before = rig.services["left"].forces
            rig.wait_for(lambda r: r.services["left"].forces > before + 50 and is_zero(r.services["left"]), "a new connection with zero force")

    def test_a_killed_firmware_leaves_no_force(self):
        with BridgedRig(watchdog_ms=100) as rig:
            self.feel(rig)
            rig.kill("firmware")
            rig.wait_for(lambda r: all(map(is_zero, r.services.values())), "zero force after the drives' watchdog")
            stats = rig.device_stats("left")
            self.assertGreater(stats["watchdog_trips"], 0)

    def test_a_killed_bridge_is_a_lost_bus(self):
        """Nobody tells the device of a killed bridge to end its force: the last one on the connection stands (docs/bridge.md)."""
        with BridgedRig() as rig:
            self.feel(rig)
            service = rig.services["left"]
            before = len(service.left_behind)
            rig.kill("left")
            rig.wait_for(lambda r: r.state_is(STATE_FAULT), "FAULT")
            ticks = list(rig.listener.ticks)
            first = next(t for t in ticks if t.fault)
            self.assertEqual(first.fault, FAULT_BUS_LOST, rig.words())
            pushing = [t.tick for t in ticks if t.tick >= first.tick and any(t.torque_permille[0]) | any(t.torque_permille[1])]
            print(f"  {len(pushing)} ticks with torque from the fault on", flush=True)
            self.assertEqual(pushing, [])
            rig.wait_for(lambda r: is_zero(r.services["right"]), "zero force at the other device")
            rig.wait_for(lambda r: len(service.left_behind) > before, "the end of the connection")

    def test_a_device_that_is_not_calibrated_is_not_used(self):
        service = InverseService()
        self.addCleanup(service.stop)
        service.calibrated = False
        with tempfile.TemporaryDirectory() as folder:
            bridge = subprocess.Popen([BIN / "ligature-bridge", "--bus", f"local:{folder}/bus", "--device", RECORD, "--haply", service.url],
                                      cwd=ROOT, stdout=subprocess.PIPE, text=True)
            self.addCleanup(bridge.wait)
            end = time.monotonic() + 30
            while service.forces < 20 and time.monotonic() < end:
                threading.Event().wait(0.01)
            self.assertGreaterEqual(service.forces, 20)
            self.assertEqual(service.peak, 0.0)
            bridge.terminate()
            self.assertNotIn("answers", bridge.communicate(timeout=30)[0])

    def test_bad_input_is_refused_in_one_line(self):
        for words, ends in ((("--haply", "http://x:1"), "allowed ws://HOST:PORT"), (("--haply", "ws://127.0.0.1:70000"), "allowed ws://"),
                            (("--backend", "/no/such.so"), "/no/such.so"), ((), "--haply or --backend")):
            done = run("ligature-bridge", "--bus", "local:/tmp/never", "--device", RECORD, *words)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(ends, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        done = run("ligature-bridge", "--bus", "local:/tmp/never", "--device", RECORD, "--rate", 250, "--haply", "ws://127.0.0.1:1")
        self.assertEqual((done.returncode, "drives.delay_s: found 0.0025" in done.stderr), (2, True), done.stderr)
        done = run("ligature-bridge", "--bus", "local:/tmp/never", "--device", "scenes/devices/omni.toml", "--haply", "ws://127.0.0.1:1")
        self.assertEqual((done.returncode, 'allowed kinematics = "cartesian"' in done.stderr), (2, True), done.stderr)

    def test_a_back_end_library_is_used(self):
        """The example of docs/bridge.md, compiled as the page says."""
        page = (ROOT / "docs/bridge.md").read_text()
        code = page.split("```c\n", 1)[1].split("```", 1)[0]
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "my_device.c").write_text(code)
            subprocess.run(["gcc", "-shared", "-fPIC", "-Wall", "-Werror", f"-I{ROOT}", "-o", path / "my_device.so", path / "my_device.c"], check=True)
            bridge = subprocess.Popen([BIN / "ligature-bridge", "--bus", f"local:{path}/bus", "--device", RECORD, "--backend", path / "my_device.so",
                                       "--stats", path / "stats.json"], cwd=ROOT, stdout=subprocess.PIPE, text=True)
            self.addCleanup(bridge.stdout.close)
            self.addCleanup(bridge.wait)
            while "answers" not in bridge.stdout.readline():
                self.assertIsNone(bridge.poll())
            bridge.terminate()
            self.assertEqual(bridge.wait(timeout=30), 0)
            self.assertGreater(json.loads((path / "stats.json").read_text())["exchanges"], 0)


if __name__ == "__main__":
    os.chdir(ROOT)
    unittest.main(verbosity=2)
