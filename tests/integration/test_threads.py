"""Cores, policy and priority of a running controller's threads, as the kernel reports them; --rt=enforce ends a run
that does not get them. Where this machine refuses a right, the program must report it."""

import os
import pathlib
import unittest

from bare_rig import BareRig

FIFO, LOOP, PHYSICS = 1, 80, 70
LOCKS = not os.environ.get("LIGATURE_SANITIZE")  # with a sanitizer mlockall locks nothing and reports success


class Thread:
    def __init__(self, folder):
        fields = (folder / "stat").read_text().rpartition(")")[2].split()
        self.priority, self.policy = int(fields[37]), int(fields[38])  # fields 40 and 41 of stat
        lines = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines() if ":" in line)
        self.sleeps = int(lines["voluntary_ctxt_switches"])
        self.cores = set(os.sched_getaffinity(int(folder.name)))


def threads_of(process):
    found = []
    for folder in pathlib.Path(f"/proc/{process.pid}/task").iterdir():
        try:
            found.append(Thread(folder))
        except (FileNotFoundError, ProcessLookupError):  # it has just ended
            pass
    return found


def core_for_real_time():
    isolated = pathlib.Path("/sys/devices/system/cpu/isolated").read_text().strip()
    return int(isolated.replace("-", ",").split(",")[-1]) if isolated else max(os.sched_getaffinity(0))


class Threads(BareRig):
    def the_pair(self, process, core):
        """The threads of the loop and of the physics, recognised by what they do: bound to `core`, and asleep once per
        period. None unless there are exactly two."""
        self.assertIsNone(process.poll(), "it ended")
        beating = [t for t in threads_of(process) if t.cores == {core} and t.sleeps > 100]
        return beating if len(beating) == 2 else None

    def test_the_loop_has_a_core_and_a_priority_of_its_own(self):
        core, allowed = core_for_real_time(), set(os.sched_getaffinity(0))
        firmware = self.start(duration=20, rt="warn")
        pair = self.wait_for(lambda: self.the_pair(firmware, core), "loop and physics on their core")
        others = [t for t in threads_of(firmware) if t.cores != {core}]
        fds = pathlib.Path(f"/proc/{firmware.pid}/fd")
        awake = any(os.readlink(fd) == "/dev/cpu_dma_latency" for fd in fds.iterdir())
        locked_kB = int(dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{firmware.pid}/status").read_text().splitlines())["VmLck"].split()[0])
        firmware.terminate()
        said, wrong = firmware.communicate(timeout=60)
        words = said + wrong
        self.assertGreaterEqual(len(others), 3, "main, telemetry, the flight recorder's")
        for t in others:
            self.assertEqual(t.cores, allowed - {core} or allowed, "every other allowed core")
            self.assertEqual((t.policy, t.priority), (0, 0), "nobody else is ahead of anybody")
        granted = "SCHED_FIFO refused" not in words
        self.assertEqual(sorted((t.policy, t.priority) for t in pair), [(FIFO, PHYSICS), (FIFO, LOOP)] if granted else [(0, 0), (0, 0)])
        self.assertEqual(awake, "short idle states" not in words, "held open, or told")
        if LOCKS:
            self.assertEqual(locked_kB > 10_000, "locked memory (mlockall) refused" not in words, locked_kB)

    def test_without_real_time_nothing_is_asked_for(self):
        firmware = self.start(duration=20, rt="off")
        self.wait_for(lambda: any(t.sleeps > 200 for t in threads_of(firmware)), "a loop")
        for t in threads_of(firmware):
            self.assertEqual((t.policy, t.priority), (0, 0))

    def test_enforce_ends_a_run_that_is_refused_something(self):
        no_rights = ("setpriv", "--bounding-set=-sys_nice,-ipc_lock", "prlimit", "--rtprio=0", "--memlock=0")
        for mode, code in (("enforce", 3), ("warn", 0)):
            firmware = self.start(rt=mode, prefix=no_rights)
            said, wrong = firmware.communicate(timeout=120)
            self.assertEqual(firmware.returncode, code, wrong)
            for what in ("SCHED_FIFO refused", "locked memory (mlockall) refused")[:2 if LOCKS else 1]:
                self.assertIn(what, said + wrong)
            last = wrong.splitlines()[-1] if wrong else ""
            self.assertEqual(last.startswith("ligature-firmware: --rt=enforce: ") and "; remedy: " in last, mode == "enforce", wrong)
            self.assertEqual("samples" in said or "tick" in said or "period" in said, mode == "warn", "what a run says at its end")


if __name__ == "__main__":
    unittest.main(verbosity=2)
