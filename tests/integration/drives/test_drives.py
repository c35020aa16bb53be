"""The firmware with drives that we did not write: an EPOS4's dictionary, served strictly by python-canopen, and nodes of
durand. For each: brought up, felt, stopped by the dead-man, by a drive's fault and by the firmware's death; and records
that do not fit are refused before any torque. docs/drives.md has the results as a matrix.

Processes without time limits: every wait is for a word, with a bound that only ends a hang."""

import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

ROOT = pathlib.Path(os.environ["LIGATURE_SOURCE"])
FIRMWARE = pathlib.Path(os.environ["LIGATURE_BIN"]) / "ligature-firmware"
HERE = pathlib.Path(__file__).resolve().parent
DEVICES = ROOT / "scenes/devices"
BOUND_S = 40
WATCHDOG_MS = 2000  # long, so that a stall of the machine is no fault


class Words:
    """The words that a process says, one line each."""

    def __init__(self, process):
        self.lines, self.more, self.why = [], threading.Condition(), lambda: ""
        threading.Thread(target=self.read, args=(process.stdout,), daemon=True).start()

    def read(self, stream):
        for line in stream:
            with self.more:
                self.lines.append(line.split())
                self.more.notify_all()

    def wait(self, word, after=0):
        """@return the first line that begins with the word, and its place, not before `after`."""
        def found():
            return next((i for i, l in enumerate(self.lines[after:], after) if l and l[0] == word), None)
        with self.more:
            if not self.more.wait_for(lambda: found() is not None, BOUND_S):
                raise AssertionError(f"'{word}' did not come: {self.lines}\n{self.why()}")
            return self.lines[found()], found() + 1


class Rig(unittest.TestCase):
    stack, table, changes, record = None, None, (), None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="drives-")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.hands = {}

    def start_hands(self, changes=()):
        for name, more in (("left", ()), ("right", ("--still",))):
            options = [o for at in (*self.changes, *changes) for o in ("--change", at)]
            hand = subprocess.Popen([sys.executable, HERE / "hand.py", self.stack, self.path / name, *([self.table] if self.table else []),
                                     *more, *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
            self.addCleanup(self.end, hand)
            self.hands[name] = (hand, Words(hand))
            self.hands[name][1].wait("ready")
        self.left = self.hands["left"][1]

    @staticmethod
    def end(process):
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout, process.stderr):
            if stream:
                stream.close()

    def end_hands(self):
        for name, (hand, _) in self.hands.items():
            self.end(hand)
            (self.path / name).unlink()

    def tell(self, word):
        hand, words = self.hands["left"]
        place = len(words.lines)
        hand.stdin.write(word + "\n")
        return place

    def device(self, *replacements):
        """The record with some of its text replaced."""
        text = (DEVICES / self.record).read_text()
        for old, new in replacements:
            self.assertEqual(text.count(old), 1, old)
            text = text.replace(old, new)
        file = self.path / "device.toml"
        file.write_text(text)
        return file

    def firmware(self, device, *more, ends=("--exit-on-fault",)):
        process = subprocess.Popen([FIRMWARE, "run", "--scene", "scenes/paper.toml", "--left", f"local:{self.path / 'left'}", "--right",
                                    f"local:{self.path / 'right'}", "--device", device, "--arm", "--force", "--no-telemetry", "--recorder", "none",
                                    "--set", "hands.energy_credit_J=0.02", "--watchdog-ms", str(WATCHDOG_MS), *ends, *more],
                                   cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end, process)
        return process

    def refused(self, device, *more):
        """Runs the firmware to its end. @return exit code and the line that says why; no drive may have been enabled."""
        place = len(self.left.lines) if self.hands else 0
        process = self.firmware(device, *more)
        _, errors = process.communicate(timeout=BOUND_S)
        if self.hands:
            self.assertFalse([l for l in self.left.lines[place:] if l[0] in ("enabled", "felt")])
        lines = [l for l in errors.splitlines() if l.startswith("ligature-firmware:")]
        self.assertEqual(len(lines), 1, errors)
        return process.returncode, lines[0]


class Matrix:
    """The rows of the matrix in docs/drives.md, for the stack of the class."""

    accept = ()
    most_ticks_by_fault = 10
    error_code = "0x2310 (8976)"  # what the drive that fails sends

    def test_brought_up_felt_and_stopped(self):
        self.start_hands()
        device = self.device(*self.replaced)
        firmware = self.firmware(device, *self.accept)
        self.left.why = lambda: firmware.communicate()[1] if firmware.poll() is not None else ""
        _, at = self.left.wait("enabled")
        self.left.wait("felt", at)
        at = self.tell("release")
        zero, _ = self.left.wait("zero", at)
        self.assertLessEqual(int(zero[2]), 100, "ticks until the released hand is free")
        self.left.wait("felt", self.tell("press"))
        zero_by_fault, _ = self.left.wait("zero", self.tell("fail"))
        self.assertLessEqual(int(zero_by_fault[2]), self.most_ticks_by_fault, "ticks until a fault has removed all torque")
        _, errors = firmware.communicate(timeout=BOUND_S)
        self.assertEqual(firmware.returncode, 3, errors)
        self.assertIn(f"fault 12: drive fault, left hand, shoulder (node 2), error code {self.error_code}", errors)
        for line in self.lacks:
            self.assertIn(line, errors)

        at = self.left.wait("silent", at)[1]
        firmware = self.firmware(device, *self.accept)
        self.left.wait("felt", at)
        firmware.kill()
        silent, _ = self.left.wait("silent", self.left.wait("gone", at)[1])
        print(f"{self.stack}: zero {zero[2]} ticks after the dead-man, {zero_by_fault[2]} after a fault; "
              f"{silent[1]} ms after SIGKILL the torque was {silent[2]}")
        self.judge_death(int(silent[1]), int(silent[2]))


class Epos4(Matrix, Rig):
    """The maker's dictionary. Its drives notice the controller's death by its heartbeat."""

    stack, table, record, replaced = "canopen_nodes", ROOT / "tests/fixtures/epos4_objects.csv", "epos4.toml", ()
    changes = ("6076:0=75000", "3010:1=1024")  # what somebody who sets up the drives writes: rated torque in uN m, lines of the encoder
    lacks = ("no watchdog on torque messages", "no sign of life from the buttons", "no torque limit of its own")

    def judge_death(self, ms, torque):
        self.assertEqual(torque, 0, "the heartbeat's watchdog removes the torque")
        self.assertGreater(ms, 0)

    def test_what_does_not_fit_is_refused_before_any_torque(self):
        self.start_hands()
        code, line = self.refused(self.device(("rated_torque_unit_Nm = 1e-6", "rated_torque_unit_Nm = 1e-3")))
        self.assertEqual(code, 3)
        self.assertIn("left hand: node 1, object 0x6076:00: found 75000, allowed 75", line)
        code, line = self.refused(self.device(('max_torque_object = "none"', 'max_torque_object = "0x6072:00"')))
        self.assertIn("object 0x6072:00: refused by the drive, abort code 0x06020000", line)
        code, line = self.refused(self.device(('watchdog = "heartbeat"', 'watchdog = "rpdo-timer"')))
        self.assertIn("object 0x1400:05: refused by the drive, abort code 0x06090011", line)
        for serial_number in ("0x2100:01", "0x3141:02"):
            code, line = self.refused(self.device(('buttons_object = "0x3141:01"', f'buttons_object = "{serial_number}"')))
            self.assertIn("node 3, object 0x1A01:01: refused by the drive, abort code 0x06040041", line)
        code, line = self.refused(DEVICES / "omni.toml")
        self.assertEqual(code, 3)
        self.assertIn("left hand: node 1, object 0x6076:00: found 75000, allowed 300", line)

    def test_a_drive_in_another_mode_is_refused(self):
        self.start_hands(changes=("6061:0=9",))
        _, line = self.refused(self.device())
        self.assertIn("left hand: node 1, object 0x6061:00: found 9, allowed 10", line)

    def test_a_drive_that_obeys_nothing_is_ended_by_its_watchdog(self):
        """The firmware goes on after the fault; only its heartbeats must not."""
        for ends in ((), ("--exit-on-fault",)):
            with self.subTest(ends=ends):
                self.start_hands()
                firmware = self.firmware(self.device(), ends=ends)
                self.left.why = lambda: firmware.communicate()[1] if firmware.poll() is not None else ""
                self.left.wait("felt")
                self.left.wait("silent" if ends else "zero", self.tell("run-away"))
                self.assertEqual(self.left.lines[-1][-1] if ends else "0", "0", "the torque that is left")
                firmware.terminate()
                self.assertIn("fault 26", firmware.communicate(timeout=BOUND_S)[1])
                self.end_hands()

    def test_another_encoder_is_refused(self):
        self.start_hands(changes=("3010:1=500",))
        _, line = self.refused(self.device())
        self.assertIn("object 0x3010:01: found 500, allowed 1024", line)


class Durand(Matrix, Rig):
    """A drive without any watchdog: after the controller's death the last torque acts on."""

    stack, record, accept = "durand_nodes", "generic-cia402.toml", ("--accept-no-drive-watchdog",)
    replaced = (('watchdog = "heartbeat"', 'watchdog = "none"'),)
    lacks = ("no watchdog: if the controller falls silent", "no sign of life from the buttons")

    def judge_death(self, ms, torque):
        self.assertNotEqual(torque, 0, "nothing in this drive removes the torque: the page says so")

    def test_no_watchdog_needs_a_word(self):
        code, line = self.refused(self.device(*self.replaced))
        self.assertEqual(code, 2)
        self.assertIn("--accept-no-drive-watchdog", line)

    def test_what_the_record_calls_optional_may_be_missing(self):
        self.start_hands(changes=("6072:0=none",))
        firmware = self.firmware(self.device(*self.replaced), *self.accept)
        self.left.wait("enabled")
        firmware.terminate()
        _, errors = firmware.communicate(timeout=BOUND_S)
        self.assertEqual(firmware.returncode, 0, errors)
        for node in (1, 2, 3):
            self.assertIn(f"drives: node {node}, object 0x6072:00: missing in this drive, optional in its record", errors)

    def test_a_missing_watchdog_object_is_refused(self):
        self.start_hands()
        code, line = self.refused(self.device())
        self.assertEqual(code, 3)
        self.assertIn("object 0x1016:01: refused by the drive, abort code 0x06020000", line)


class Odrive(Matrix, Rig):
    """Drives without SYNC, with frames as the DBC of somebody else says. Every frame feeds their watchdog. Times are long, because
    Python drives are late on a busy machine."""

    stack, record = "odrive_nodes", "odrive.toml"
    replaced = (("watchdog_ms = 20 ", "watchdog_ms = 600 "), ("heartbeat_ms = 10 ", "heartbeat_ms = 50 "))
    changes = ("0:0=600", "0:2=1")
    error_code = "0x0020 (32)"
    lacks = ("no report of the torque", "told by its heartbeat only, up to 50 ms later", "limits, torque constant and encoder offset cannot be read back")
    most_ticks_by_fault = 60  # the heartbeat of 20 ms, and a Python drive that is late

    def judge_death(self, ms, torque):
        self.assertEqual(torque, 0, "the watchdog removes the torque")

    def refused_by_trial(self, *changes):
        self.changes = changes
        self.start_hands()
        place = len(self.left.lines)
        process = self.firmware(self.device(*self.replaced))
        _, errors = process.communicate(timeout=BOUND_S)
        self.assertEqual(process.returncode, 3, errors)
        self.assertFalse([l for l in self.left.lines[place:] if l[0] == "felt"], "no torque but that of the trial")
        return errors

    def test_a_watchdog_that_is_late_is_found_before_any_torque(self):
        self.assertIn("left hand: node 1: no watchdog of 600 ms", self.refused_by_trial("0:0=1500"))

    def test_drives_that_do_not_take_the_torque_messages_are_refused(self):
        self.assertIn("left hand: node 1: does not aim at the torque that it is told", self.refused_by_trial("0:0=600", "0:1=1"))

    def test_drives_that_stay_in_position_mode_are_refused(self):
        self.assertIn("left hand: node 1: does not aim at the torque that it is told", self.refused_by_trial("0:0=600", "0:4=1"))

    def test_buttons_without_sign_of_life_are_refused(self):
        self.assertIn("left hand: the button module does not answer", self.refused_by_trial("0:0=600", "0:3=1"))

    def test_no_watchdog_needs_a_word(self):
        code, line = self.refused(self.device(('watchdog = "setpoints"', 'watchdog = "none"')))
        self.assertEqual(code, 2)
        self.assertIn("--accept-no-drive-watchdog", line)


class Moteus(Matrix, Rig):
    """Drives on CAN-FD, with frames as the maker's package makes and reads them. Their watchdog damps."""

    stack, record, replaced, accept = "moteus_nodes", "moteus.toml", (), ("--accept-no-drive-watchdog",)
    lacks = ("what a drive does after its watchdog is not checked", "calibration and position offset cannot be compared")
    error_code = "0x0021 (33)"
    most_ticks_by_fault = 20  # the next answer, and a Python drive that is late

    def judge_death(self, ms, torque):
        damps, _ = self.left.wait("damps")
        self.assertGreaterEqual(int(damps[2]), WATCHDOG_MS, "the time that the firmware told the drives")
        place = len(self.left.lines)
        firmware = self.firmware(self.device(), *self.accept)
        self.left.why = lambda: firmware.communicate()[1] if firmware.poll() is not None else ""
        self.left.wait("enabled", place)  # a drive that damps switches on only after a stop

    def test_an_unchecked_watchdog_needs_a_word(self):
        code, line = self.refused(self.device())
        self.assertEqual(code, 2)
        self.assertIn("--accept-no-drive-watchdog", line)

    def refused_with(self, *changes):
        self.start_hands(changes=changes)
        process = self.firmware(self.device(), *self.accept)
        _, errors = process.communicate(timeout=BOUND_S)
        self.assertEqual(process.returncode, 3, errors)
        self.assertFalse([l for l in self.left.lines if l[0] == "felt"])
        return errors

    def test_a_drive_without_watchdog_is_refused(self):
        errors = self.refused_with("0:0=1")
        self.assertIn("left hand: node 1 (mode 10, fault 0): no watchdog of 2000 ms", errors)
        self.assertNotIn("cut its power", errors)

    def test_drives_that_keep_their_gains_are_refused(self):
        self.assertIn("does not switch on and stay so, with the settings that it is told", self.refused_with("0:2=1"))

    def test_buttons_without_sign_of_life_are_refused(self):
        self.assertIn("left hand: the button module does not answer", self.refused_with("0:1=1"))

    def test_a_drive_that_stays_in_its_stored_mode_is_refused_and_named(self):
        errors = self.refused_with("0:3=6")
        self.assertIn("left hand: node 3 (mode 6, fault 0): does not say that it has stopped", errors)
        self.assertIn("node 3 (mode 6, fault 0): does not say that it is off: cut its power", errors)


class Doctor(unittest.TestCase):
    def test_doctor_says_what_the_drives_of_a_record_lack(self):
        def doctor(record):
            return subprocess.run([FIRMWARE, "doctor", "--seconds", "0", "--device", record], capture_output=True, text=True, timeout=BOUND_S)
        told = doctor(DEVICES / "epos4.toml").stdout
        self.assertRegex(told, r"WARN  drives +no watchdog on torque messages: .* for up to 40 ms")
        self.assertRegex(doctor(DEVICES / "omni.toml").stdout, "OK    drives +omni-class: nothing is missing")
        missing = doctor("/nowhere/device.toml")
        self.assertEqual((missing.returncode, len(missing.stderr.splitlines())), (2, 1))


if __name__ == "__main__":
    unittest.main(verbosity=2)
