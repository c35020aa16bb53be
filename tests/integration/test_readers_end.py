"""Programs that read a recording must end: at the end of the data, whatever size the file header claims, and on a
signal.

Every wait is for a condition, with a limit that only ends a hang."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

HOST = pathlib.Path(os.environ["LIGATURE_BIN"]) / "ligature-host"
sys.path.insert(0, os.environ["LIGATURE_LCM_PYTHON"])

import lcm  # noqa: E402
from ligature_msg import thread_t, tick_batch_t, tick_t  # noqa: E402

BOUND_S, HUGE = 60, 60_000_000_000


def write_log(path):
    log = lcm.EventLog(str(path), "w", overwrite=True)
    batch = tick_batch_t()
    batch.session, batch.count, batch.ticks = 1, 20, [tick_t() for _ in range(20)]
    for number, tick in enumerate(batch.ticks):
        tick.tick = number
    thread = thread_t()
    thread.count, thread.p_W_m, thread.tension_N, thread.turn_rad = 4, [[0.1 * i, 0.0, 0.0] for i in range(4)], [0.0] * 4, [0.0] * 4
    for i, (channel, message) in enumerate((("TICKS", batch), ("THREAD", thread))):
        log.write_event(1_000_000 + i, f"LIGATURE_{channel}", message.encode())
    log.close()


class Readers(unittest.TestCase):
    def setUp(self):
        self.path = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.log = self.path / "a.lcmlog"
        write_log(self.log)

    def start(self, *words, **how):
        process = subprocess.Popen([HOST, *map(str, words)], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how)
        self.addCleanup(process.communicate)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def words_of(self, process):
        out, err = process.communicate(timeout=BOUND_S)
        return process.returncode, out + err

    def test_a_sparse_end_of_60_GB_is_passed_over(self):
        os.truncate(self.log, HUGE)
        for words, ends in (("report", "log damaged"), ("export", "bytes left out"), ("knot", "0_1")):
            more = ("--forces", "f.csv") if words == "export" else ()
            code, said = self.words_of(self.start(words, self.log, *more))
            self.assertEqual(code, 0, said)
            self.assertIn(ends, said)

    def test_a_sparse_middle_hides_nothing_behind_it(self):
        whole = self.log.read_bytes()
        os.truncate(self.log, HUGE)
        with open(self.log, "r+b") as file:
            file.seek(HUGE)
            file.write(whole)
        code, said = self.words_of(self.start("report", self.log))
        self.assertEqual(code, 0, said)
        self.assertIn("duplicates         20 ticks", said)

    def test_replay_opens_it_and_ends(self):
        os.truncate(self.log, HUGE)
        replay = self.start("replay", self.log, "--port", 0)
        self.assertIn("open http://", replay.stdout.readline())
        replay.send_signal(signal.SIGTERM)
        self.assertEqual(self.words_of(replay)[0], 0)

    def test_a_signal_ends_what_waits_for_python(self):
        slow, started = self.path / "python", self.path / "started"
        slow.write_text(f"#!/bin/sh\ntouch {started}\nexec sleep 3600\n")
        slow.chmod(0o755)
        for words in (("plot", self.log, "--out", "a.png"), ("compare", self.log, self.log, "--out", "a.png")):
            process = self.start(*words, env={**os.environ, "LIGATURE_PYTHON": str(slow)})
            for _ in range(BOUND_S * 20):
                if started.exists():
                    break
                threading.Event().wait(0.05)
            self.assertTrue(started.exists(), words)
            process.send_signal(signal.SIGTERM)
            code, said = self.words_of(process)
            self.assertEqual(code, 3, said)
            self.assertIn("signal", said)
            started.unlink()
        self.assertEqual([p.name for p in self.path.glob("a.*")], ["a.lcmlog"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
