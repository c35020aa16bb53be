"""The recorder with peers that send false data, with a second recorder, and after a killed firmware. No rig runs; the
test makes the ticks.

Every wait is for a condition, with a limit that only ends a hang."""

import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, os.environ["LIGATURE_LCM_PYTHON"])
import lcm  # noqa: E402
from ligature_msg import status_t, tick_batch_t, tick_t  # noqa: E402

BIN = pathlib.Path(os.environ["LIGATURE_BIN"])
BOUND_S = 60
SESSION = 1_700_000_000_000_000
HEADER_BYTES, SLOT_BYTES = 65536, 1024
CHECK_BYTES = 28 + len("LIGATURE_CHECK") + 12  # checksum after each event of a log (host/log_format.hpp)


def batch(session, first, count):
    ticks = []
    for number in range(first, first + count):
        tick = tick_t()
        tick.tick, tick.scheduled_ns = number, number * 1_000_000 % (1 << 62)
        ticks.append(tick)
    made = tick_batch_t()
    made.utime, made.session, made.count, made.ticks = session, session, count, ticks
    return made.encode()


def status(session, recorder_file):
    made = status_t()
    made.session, made.period_s, made.max_force_N, made.recorder_file = session, 0.001, 3.3, str(recorder_file)
    return made.encode()


def flight_file(path, session, ticks):
    """Writes a flight recorder's file as specified in protocol/recorder/flight_file.hpp, independently of the firmware.
    """
    header = struct.pack("<8sIIqqqddiI", b"LGFLIGHT", 3, SLOT_BYTES, len(ticks), struct.unpack(">q", tick_t._get_packed_fingerprint())[0],
                         session, 0.001, 3.3, 0, 0) + bytes(32 + 256 + 61440)
    header += struct.pack("<I", zlib.crc32(header))
    slots = bytearray()
    for i, tick in enumerate(ticks):
        payload = tick.encode()[8:]
        head = struct.pack("<QI", i + 1, len(payload))
        slots += (head + struct.pack("<I", zlib.crc32(payload, zlib.crc32(head))) + payload).ljust(SLOT_BYTES, b"\0")
    path.write_bytes(header.ljust(HEADER_BYTES, b"\0") + bytes(slots))


def ticks_of(session, first, count):
    return tick_batch_t.decode(batch(session, first, count)).ticks


class Recorder:
    """A recorder process and the network on which it listens."""

    def __init__(self, folder, name="a.lcmlog", *more):
        self.log = folder / name
        self.process = subprocess.Popen([BIN / "ligature-host", "record", "--out", self.log, "--quiet", "--flight-folder", folder, *more],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def has(self, size):
        return self.log.exists() and self.log.stat().st_size >= size

    def end(self):
        """Exit code and output after SIGTERM."""
        self.process.send_signal(signal.SIGTERM)
        out, err = self.process.communicate(timeout=BOUND_S)
        return self.process.returncode, out + err

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


class Records(unittest.TestCase):
    def setUp(self):
        self.path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.lcm = lcm.LCM("udpm://239.255.76.67:7667?ttl=0")
        self.written = 0

    def recorder(self, *more, name="a.lcmlog"):
        """Starts a recorder and waits until it receives messages; earlier messages would not be recorded."""
        recorder = self.enterContext(Recorder(self.path, name, *more))
        self.until(recorder, lambda: recorder.has(1), lambda: self.lcm.publish("LIGATURE_HELLO", b"hello"))
        return recorder

    def until(self, recorder, condition, do=lambda: None):
        """Repeats `do` until the condition holds; it is an error if the recorder ends."""
        for _ in range(BOUND_S * 100):
            do()
            if condition():
                return
            with self.assertRaises(subprocess.TimeoutExpired, msg="the recorder has ended"):
                recorder.process.wait(0.01)
        self.fail("did not come")

    def say(self, recorder, *messages):
        """Publishes messages, a few at a time, and waits until the log holds all of them."""
        size = recorder.log.stat().st_size
        for i, (channel, data) in enumerate(messages):
            self.lcm.publish(channel, data)
            size += 28 + len(channel) + len(data) + CHECK_BYTES
            if i % 20 == 19 or i + 1 == len(messages):
                self.until(recorder, lambda: recorder.has(size))

    def report(self, log):
        done = subprocess.run([BIN / "ligature-host", "report", log], capture_output=True, text=True, timeout=BOUND_S)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout


class Forged(Records):
    def test_what_a_status_names_cannot_hold_the_recorder_up(self):
        """Status messages may name pipes, devices, links, folders or files elsewhere: the recorder waits for none of
        them and still reports the gaps."""
        os.mkfifo(self.path / "pipe")
        (self.path / "link").symlink_to("pipe")
        (self.path / "folder").mkdir()
        elsewhere = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory())) / "flight.rec"
        flight_file(elsewhere, SESSION, ticks_of(SESSION, 0, 60))
        (self.path / "there").symlink_to(elsewhere)
        recorder = self.recorder()
        for name in (self.path / "pipe", self.path / "link", "/proc/kmsg", "/dev/tty", "/dev/zero", self.path / "folder", self.path / "there",
                     f"{self.path}/../{elsewhere.parent.name}/flight.rec", elsewhere, "flight.rec", self.path, "/"):
            self.say(recorder, ("LIGATURE_STATUS", status(SESSION, name)))
        self.say(recorder, ("LIGATURE_TICKS", batch(SESSION, 0, 20)), ("LIGATURE_TICKS", batch(SESSION, 40, 20)))
        # The recorder looks for missing ticks once a second; it must go on writing afterwards.
        size = recorder.log.stat().st_size
        self.until(recorder, lambda: recorder.has(size + 250 * (40 + CHECK_BYTES)), lambda: self.lcm.publish("LIGATURE_HELLO", b"hello"))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("recorded 40 of at least 60 ticks, 20 known to be lost", words)
        self.assertIn("was not read", words)

    def test_a_file_of_another_session_fills_nothing(self):
        flight_file(self.path / "flight.rec", SESSION + 1, ticks_of(SESSION, 0, 80))
        recorder = self.recorder()
        self.say(recorder, ("LIGATURE_STATUS", status(SESSION, self.path / "flight.rec")),
                 ("LIGATURE_TICKS", batch(SESSION, 0, 20)), ("LIGATURE_TICKS", batch(SESSION, 40, 20)))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("recorded 40 of at least 60 ticks, 20 known to be lost", words)

    def test_sessions_without_end_hide_no_ticks(self):
        """1000 forged session ids fill the recorder's list of sessions; later ticks are still recorded and counted
        correctly."""
        recorder = self.recorder()
        self.say(recorder, *[("LIGATURE_TICKS", batch(i + 1, 0, 1)) for i in range(1000)],
                 *[("LIGATURE_TICKS", batch(SESSION, 20 * i, 20)) for i in range(130)])
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("not counted: 2600 ticks", words)
        self.assertNotIn(" 0 lost", words)
        report = self.report(recorder.log)
        self.assertIn("2600 ticks of further sessions", report)
        self.assertNotIn(" 0 lost", report)

    def test_numbers_that_no_run_has_are_refused(self):
        recorder = self.recorder()
        backwards = tick_batch_t.decode(batch(SESSION, 20, 20))
        backwards.ticks.reverse()
        self.say(recorder, ("LIGATURE_TICKS", batch(SESSION, 0, 20)), ("LIGATURE_TICKS", batch(SESSION, 2251782635847000, 20)),
                 ("LIGATURE_TICKS", batch(SESSION, -20, 20)), ("LIGATURE_TICKS", backwards.encode()))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("unreadable: 3 messages", words)
        report = self.report(recorder.log)
        self.assertIn("run of 0.020 s", report)


class Damaged(Records):
    def test_a_damaged_record_is_left_out_and_said(self):
        recorder = self.recorder()
        # A checksum message that does not belong to the event before it, replayed or forged.
        false_check = struct.pack(">qI", 0, 0)
        self.say(recorder, *[("LIGATURE_TICKS", batch(SESSION, 20 * i, 20)) for i in range(10)])
        self.lcm.publish("LIGATURE_CHECK", false_check)
        self.say(recorder, *[("LIGATURE_TICKS", batch(SESSION, 20 * i, 20)) for i in range(10, 20)])
        self.assertEqual(recorder.end()[0], 0)
        sound = self.report(recorder.log)
        self.assertIn("400 recorded, 0 lost", sound)
        self.assertNotIn("damaged", sound)
        log = bytearray(recorder.log.read_bytes())
        log[log.index(b"LIGATURE_TICKS", len(log) // 2) + 500] ^= 4  # a byte within a tick
        recorder.log.write_bytes(log)
        damaged = self.report(recorder.log)
        self.assertIn("380 recorded, 20 lost", damaged)
        self.assertIn("1 damaged records left out", damaged)


class Beside(Records):
    def test_a_second_recorder_of_the_same_file_is_refused(self):
        first = self.recorder()
        self.say(first, ("LIGATURE_TICKS", batch(SESSION, 0, 20)))
        for more in ((), ("--force",)):
            second = self.enterContext(Recorder(self.path, "a.lcmlog", *more))
            out, err = second.process.communicate(timeout=BOUND_S)
            self.assertEqual(second.process.returncode, 2, out + err)
            self.assertIn("a.lcmlog", err)
        (self.path / "link.lcmlog").symlink_to("a.lcmlog")
        third = self.enterContext(Recorder(self.path, "link.lcmlog", "--force"))
        out, err = third.process.communicate(timeout=BOUND_S)
        self.assertEqual(third.process.returncode, 2, out + err)
        self.assertIn("another recorder", err)
        self.say(first, ("LIGATURE_TICKS", batch(SESSION, 20, 20)))
        code, words = first.end()
        self.assertEqual(code, 0, words)
        self.assertIn("40 recorded", self.report(first.log))
        size = first.log.stat().st_size
        again = self.recorder("--force")  # the lock ends with the process
        self.until(again, lambda: not again.has(size), lambda: self.lcm.publish("LIGATURE_HELLO", b"hello"))
        self.say(again, ("LIGATURE_TICKS", batch(SESSION, 0, 20)))
        self.assertEqual(again.end()[0], 0)


    def test_a_recording_that_force_would_replace_stays_until_a_message_comes(self):
        (self.path / "a.lcmlog").write_bytes(b"precious")
        waiting = self.enterContext(Recorder(self.path, "a.lcmlog", "--force", "--duration", "0.3"))
        out, err = waiting.process.communicate(timeout=BOUND_S)
        self.assertEqual(waiting.process.returncode, 3, out + err)
        self.assertIn("no message came", err)
        self.assertEqual((self.path / "a.lcmlog").read_bytes(), b"precious")
        empty = self.enterContext(Recorder(self.path, "b.lcmlog", "--force", "--duration", "0.3"))
        empty.process.communicate(timeout=BOUND_S)
        self.assertFalse((self.path / "b.lcmlog").exists(), "nothing is left of a new file without a message")


class Ends(Records):
    def test_the_last_ticks_of_a_killed_firmware_come_from_its_flight_recorder(self):
        flight_file(self.path / "flight.rec", SESSION, ticks_of(SESSION, 0, 80))
        recorder = self.recorder()
        self.say(recorder, ("LIGATURE_STATUS", status(SESSION, self.path / "flight.rec")),
                 ("LIGATURE_TICKS", batch(SESSION, 0, 20)), ("LIGATURE_TICKS", batch(SESSION, 40, 20)))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("recorded 80 of 80 ticks, 0 lost", words)
        self.assertIn("40 of the ticks came from the flight recorder", words)
        self.assertIn("80 recorded", self.report(recorder.log))

    def test_a_restarted_firmware_has_moved_the_file(self):
        flight_file(self.path / "flight.rec.previous", SESSION, ticks_of(SESSION, 0, 70))
        flight_file(self.path / "flight.rec", SESSION + 1, ticks_of(SESSION, 0, 50))
        recorder = self.recorder()
        for session in (SESSION, SESSION + 1):
            self.say(recorder, ("LIGATURE_STATUS", status(session, self.path / "flight.rec")), ("LIGATURE_TICKS", batch(session, 0, 20)))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("recorded 120 of 120 ticks, 0 lost", words)

    def test_an_end_that_nobody_knows_is_said(self):
        recorder = self.recorder()
        self.say(recorder, ("LIGATURE_TICKS", batch(SESSION, 0, 20)))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("recorded 20 of at least 20 ticks, 0 known to be lost", words)
        self.assertIn("session 1 ended after tick 19 or later", words)

    def test_forged_names_do_not_keep_the_right_one_out(self):
        """The recorder keeps at most 16 names of flight recorder files; names of other files are dropped, so the right
        one still has room."""
        flight_file(self.path / "flight.rec", SESSION, ticks_of(SESSION, 0, 60))
        recorder = self.recorder()
        self.say(recorder, *[("LIGATURE_STATUS", status(SESSION, self.path / f"forged-{i}")) for i in range(40)],
                 ("LIGATURE_TICKS", batch(SESSION, 0, 20)), ("LIGATURE_TICKS", batch(SESSION, 40, 20)))
        filled = recorder.log.stat().st_size + 20 * 400
        self.until(recorder, lambda: recorder.has(filled + 20 * 1000), lambda: self.lcm.publish("LIGATURE_STATUS", status(SESSION, self.path / "flight.rec")))
        code, words = recorder.end()
        self.assertEqual(code, 0, words)
        self.assertIn("recorded 60 of 60 ticks, 0 lost", words)


if __name__ == "__main__":
    unittest.main(verbosity=2)
