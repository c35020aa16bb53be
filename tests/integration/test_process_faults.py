"""Faults of the rig's processes, its network and its disk while both hands render force. Part of the fault matrix: the
@row texts state each fault and the rig's reaction; together they are docs/measurements/fault-matrix-processes.md.

These are real processes, so no times are asserted; reactions exact to the tick are in FaultMatrix.* and scripts/test-hil.
"""

import json
import os
import pathlib
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import unittest

from rig import BIN, FLAG_PERIOD_LOST, HANDS, LCM_URL, ROOT, STATE_ENGAGE, STATE_FAULT, STATE_FORCE, STATE_IDLE, Rig, run
from seeds import shifted

sys.path.insert(0, os.environ["LIGATURE_LCM_PYTHON"])
import lcm  # noqa: E402
from ligature_msg import ack_t, command_t, tick_batch_t  # noqa: E402

PAGE = ROOT / "docs/measurements/fault-matrix-processes.md"
HEAD = """# Fault matrix, processes

This page shows what a rig of real processes does when one of them is stopped or killed, or gets bad input.
`tests/integration/test_process_faults.py` (`ctest -R ProcessFaults`) makes this page, and fails if the page is old.
Each disturbance happens while both hands feel force. The test does not measure times: [the fault
matrix](fault-matrix.md) and [the matrix of the guest](fault-matrix-guest.md) have the deadlines in ticks. Another test,
`Rig.SurvivesDeaths`, kills the programs by SIGKILL.

| what happens | what the rig does | test |
|---|---|---|
"""
GROUP = ("239.255.76.67", 7667)
SEED = shifted(20261121)
KILLS = 100
BUS_LOST, TOO_OLD, DRIVE_FAULT, OVERRUN = 10, 11, 12, 30
ROWS = []


def row(what, ends):
    """Decorator: adds a test's row to the page."""
    def mark(test):
        ROWS.append((what, ends, test.__name__))
        return test
    return mark


def pushes(rig):
    return rig.state_is(STATE_FORCE) and all(any(hand) for hand in rig.listener.ticks[-1].torque_permille)


def is_armed(rig):
    """Whether the rig is armed. Its state is ENGAGE until the operator's motion allows force, then FORCE."""
    return rig.state_is(STATE_ENGAGE) or rig.state_is(STATE_FORCE)


def pause(seconds):
    threading.Event().wait(seconds)


class InForce(unittest.TestCase):
    def rig(self, **how):
        rig = self.enterContext(Rig(**how))
        rig.wait_for(pushes, "force on both hands")
        return rig

    def carries_on(self, rig, ticks=300):
        """Expects no fault within so many ticks, and force afterwards. Force may take a while: if this machine delays a
        hand's process for long, its next position looks too fast, and the rig brakes for a moment, without a fault."""
        seen = rig.listener.ticks[-1].tick
        rig.wait_for(lambda r: r.listener.ticks[-1].tick > seen + ticks, "more ticks")
        self.assertEqual([t.fault for t in rig.listener.ticks if t.fault], [])
        rig.wait_for(lambda r: r.state_is(STATE_FORCE), "force")
        self.assertEqual([t.fault for t in rig.listener.ticks if t.fault], [])

    def ends_in(self, rig, faults):
        """Expects one of `faults`, latched, and from then on no torque in any executed tick and none in both hands'
        drives."""
        rig.wait_for(lambda r: r.state_is(STATE_FAULT), "the fault")
        seen = rig.listener.ticks[-1].tick
        rig.wait_for(lambda r: r.listener.ticks[-1].tick > seen + 100, "more ticks")
        faulted = [t for t in rig.listener.ticks if t.fault]
        self.assertEqual(len({t.fault for t in faulted}), 1, "latched, the first one")
        self.assertIn(faulted[0].fault, faults, rig.words())
        self.assertFalse(any(any(hand) for t in faulted if not t.flags & FLAG_PERIOD_LOST for hand in t.torque_permille))

    def every_tick(self, rig):
        """Ends the run and checks that the flight recorder has all ticks, in order."""
        rig.end("firmware")
        ticks = rig.path / "ticks.csv"
        self.assertEqual(run("ligature-host", "export", rig.flight, "--ticks", ticks).returncode, 0)
        numbers = [int(line.split(",")[0]) for line in ticks.read_text().splitlines() if line[:1].isdigit()]
        self.assertEqual(numbers, list(range(len(numbers))))
        return len(numbers)


class Stopped(InForce):
    @row("SIGSTOP of one hand for 0.6 s, watchdog 0.3 s", "fault 11 or 12 on both hands, until it is reset; SIGCONT changes nothing")
    def test_a_stopped_hand(self):
        rig = self.rig(watchdog_ms=300)
        left = rig.processes["left"]
        left.send_signal(signal.SIGSTOP)
        pause(0.6)
        left.send_signal(signal.SIGCONT)
        self.ends_in(rig, (TOO_OLD, DRIVE_FAULT))
        self.assertEqual(rig.device_stats("right")["final_torque_permille"], [0, 0, 0])

    @row("SIGSTOP of the controller for 0.6 s, watchdog 0.3 s", "the drives remove their torque by themselves; when the controller runs again, fault 12 or 30 follows and stays until it is reset")
    def test_a_stopped_controller(self):
        rig = self.rig(watchdog_ms=300)
        firmware = rig.processes["firmware"]
        firmware.send_signal(signal.SIGSTOP)
        pause(0.6)
        firmware.send_signal(signal.SIGCONT)
        self.ends_in(rig, (DRIVE_FAULT, OVERRUN))
        for hand in HANDS:
            stats = rig.device_stats(hand)
            self.assertEqual(stats["final_torque_permille"], [0, 0, 0])
            self.assertGreaterEqual(stats["watchdog_trips"], 3, "each drive by itself")

    @row("SIGSTOP of the recorder for 1 s", "nothing happens to the rig; the log has every tick, filled from the flight recorder")
    def test_a_stopped_recorder(self):
        rig = self.rig(record=True)
        recorder = rig.processes["recorder"]
        recorder.send_signal(signal.SIGSTOP)
        pause(1.0)
        recorder.send_signal(signal.SIGCONT)
        self.carries_on(rig)
        rig.end("firmware")
        self.assertEqual(rig.end("recorder"), 0)
        self.assertEqual(json.loads(run("ligature-host", "report", rig.log, "--json").stdout)["ticks_lost"], 0)


class Network(InForce):
    @row("20 000 commands as fast as one process can send", "each is answered or dropped, none delays a tick; the next command is obeyed")
    def test_a_flood_of_commands(self):
        rig = self.rig()
        link = lcm.LCM("udpm://239.255.76.67:7667?ttl=0")
        command = command_t()
        for i in range(20_000):
            command.id, command.kind = i, command_t.KIND_ARM
            # Odd i: session and challenge of another run, as in a recording. Even i: a request for a challenge.
            command.session, command.challenge = (17, i) if i % 2 else (0, 0)
            link.publish("LIGATURE_COMMAND", command.encode())
        self.carries_on(rig)
        self.assertEqual(run("ligature-host", "send", "arm").returncode, 0)
        self.carries_on(rig, 50)

    @row("a recording that contains the command `arm` is played back (`lcm-logplayer`): first one of the running rig, then one of an earlier run",
         "each command but `stop` and `disarm` is refused and named in an event; the rig stays in IDLE")
    def test_a_recording_played_back(self):
        rig = self.rig(record=True, extra=("--rt=warn",))
        for word in ("disarm", "arm", "reset-thread", "disarm"):
            self.assertEqual(run("ligature-host", "send", word).returncode, 0)
            if word == "arm":
                rig.wait_for(is_armed, "arming")
        rig.wait_for(lambda r: r.state_is(STATE_IDLE), "idle")
        self.assertEqual(rig.end("recorder"), 0)
        first = rig.listener.status.session
        self.assertEqual(self.arms_when_played_back(rig), 0)
        self.assertIn(f"arm refused: command of session {first} replayed", rig.said("firmware"))

        rig.end("firmware")
        rig.start_firmware()
        rig.wait_for(lambda r: r.listener.status.session != first and is_armed(r), "the next run")
        self.assertEqual(run("ligature-host", "send", "disarm").returncode, 0)
        rig.wait_for(lambda r: r.state_is(STATE_IDLE), "idle")
        self.assertEqual(self.arms_when_played_back(rig), 0)
        self.assertRegex(rig.said("firmware"), rf"arm refused: command of session {first}, this is session \d+")
        self.assertEqual(run("ligature-host", "send", "arm").returncode, 0, "a living sender is heard")

    def arms_when_played_back(self, rig):
        """Plays the recording into the rig's own network. @return how often the firmware has left IDLE meanwhile."""
        before = rig.said("firmware").count("IDLE -> ENGAGE")
        subprocess.run(["lcm-logplayer", "--speed=4", f"--lcm-url={LCM_URL}", rig.log], check=True, capture_output=True, timeout=60)
        pause(0.3)
        self.assertTrue(rig.alive("firmware"), rig.words())
        return rig.said("firmware").count("IDLE -> ENGAGE") - before

    @row("invalid LCM packets: random bytes, a channel name without end, a wrong type hash, truncated messages, messages of 1 MB, wrong lengths", "controller and recorder ignore them")
    def test_garbage(self):
        rig = self.rig(record=True)
        chance = random.Random(SEED)
        raw = self.enterContext(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        raw.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        link = lcm.LCM("udpm://239.255.76.67:7667?ttl=0")
        good = command_t().encode()
        channels = ("LIGATURE_COMMAND", "LIGATURE_TICKS", "LIGATURE_STATUS", "LIGATURE_EVENT", "LIGATURE_THREAD", "LIGATURE_ACK")
        for i in range(300):
            raw.sendto(chance.randbytes(chance.randint(1, 1400)), GROUP)
            # A channel name without terminating zero.
            raw.sendto(struct.pack(">II", 0x4C433032, i) + b"LIGATURE_COMMAND" * 60, GROUP)
            # A fragment with a false length.
            raw.sendto(struct.pack(">IIIIHH", 0x4C433033, i, 1 << 31, 0, chance.randint(0, 9), 3) + b"x" * 64, GROUP)
            channel = channels[i % len(channels)]
            link.publish(channel, chance.randbytes(chance.randint(0, 600)))
            link.publish(channel, good[:8] + b"\xff" * 40)
            link.publish(channel, good[:chance.randint(0, len(good) - 1)])
            if i % 30 == 0:
                link.publish(channel, chance.randbytes(1_000_000))
        self.carries_on(rig)
        answers = []
        link.subscribe("LIGATURE_ACK", lambda _, data: answers.append(data))
        bad = command_t()
        bad.kind = 99
        link.publish("LIGATURE_COMMAND", bad.encode())
        while not answers:
            self.assertGreater(link.handle_timeout(20_000), 0, "no answer")
        self.assertEqual(ack_t.decode(answers[-1]).accepted, 0)
        rig.end("firmware")
        self.assertEqual(rig.end("recorder"), 0, rig.words())
        self.assertEqual(run("ligature-host", "report", rig.log, "--json").returncode, 0)

    @row("a command to load another scene while the hands feel force", "refused with the reason; the hands keep their thread")
    def test_a_scene_while_in_force(self):
        rig = self.rig()
        refused = run("ligature-host", "send", "load-scene", "desk.toml")
        self.assertEqual(refused.returncode, 3, refused.stdout)
        self.assertEqual(len(refused.stderr.splitlines()), 1)
        self.carries_on(rig)


class Recorders(InForce):
    @row(f"SIGKILL of the recorder at {KILLS} random moments of one run", "nothing happens to the rig; the flight recorder has every tick, and each log is readable up to the moment of the kill")
    def test_a_hundred_deaths_of_the_recorder(self):
        rig = self.rig()
        chance = random.Random(SEED)
        for i in range(KILLS):
            log = rig.path / f"{i}.lcmlog"
            rig.start("recorder", "ligature-host", "record", "--out", log, "--quiet")
            pause(chance.uniform(0.005, 0.12))
            if i % 10 == 0:  # so that some recorders have recorded something, on any machine
                rig.wait_for(lambda _, log=log: log.exists() and log.stat().st_size > 30_000, "ticks in the log")
            rig.kill("recorder")
        self.carries_on(rig)
        last = rig.path / "last.lcmlog"
        rig.start("recorder", "ligature-host", "record", "--out", last, "--quiet", "--flight-folder", rig.path)
        self.carries_on(rig)
        ticks = self.every_tick(rig)
        self.assertEqual(rig.end("recorder"), 0)
        self.assertEqual(json.loads(run("ligature-host", "report", last, "--json").stdout)["ticks_lost"], 0)
        readable = [log for log in rig.path.glob("*.lcmlog") if log.stat().st_size > 0]
        whole = {log: sum(tick_batch_t.decode(event.data).count for event in lcm.EventLog(str(log), "r") if event.channel == "LIGATURE_TICKS")
                 for log in readable}  # read by LCM's own reader
        self.assertGreaterEqual(sum(ticks > 0 for ticks in whole.values()), KILLS // 10)
        for log in {*chance.sample(readable, min(10, len(readable))), max(whole, key=whole.get)}:
            done = run("ligature-host", "export", log, "--forces", rig.path / "forces.csv")
            # exit code 2: the recorder was killed before it wrote the first tick
            self.assertEqual(done.returncode, 0 if whole[log] else 2, done.stderr)
            self.assertRegex(done.stdout + done.stderr, rf"exported {whole[log]} ticks" if whole[log] else "holds no readable tick")
        print(f"{KILLS} recorders killed, {len(readable)} left a log; {ticks} ticks, none missing")


class Disk(InForce):
    def small(self, folder, *command):
        """A command line with a disk of 1 MB mounted at `folder`, visible to that command only."""
        return ["unshare", "-m", "sh", "-c", f"mount -t tmpfs -o size=1m tmpfs '{folder}' && exec \"$@\"", "small", *map(str, command)]

    @row("a full disk under the recorder", "the recorder says so and ends with 3; nothing happens to the rig")
    def test_a_full_disk_under_the_recorder(self):
        rig = self.rig()
        folder = rig.path / "small"
        folder.mkdir()
        recorder = subprocess.run(self.small(folder, BIN / "ligature-host", "record", "--out", folder / "a.lcmlog", "--quiet"),
                                  capture_output=True, text=True, timeout=60)
        self.assertEqual(recorder.returncode, 3, recorder.stderr)
        self.assertIn("a.lcmlog", recorder.stderr)
        self.carries_on(rig)

    @row("a full disk under the flight recorder", "refused at the start with the reason; the rig runs without one")
    def test_a_full_disk_under_the_flight_recorder(self):
        folder = pathlib.Path(self.enterContext(Rig.folder_of_its_own()))
        rig = self.rig(prefix=self.small(folder), flight=folder / "flight.rec")
        self.assertIn("no room", rig.words())
        self.assertEqual(rig.listener.status.recorder_file, "")
        self.carries_on(rig)


class Admission(InForce):
    @row("a loop that takes longer than its allowed time", "`run` ends with exit code 3 and prints the times and the remedy; nothing is started")
    def test_what_does_not_fit_is_refused(self):
        refused = run("ligature-firmware", "run", "--scene", "scenes/paper.toml", "--left", "local:/nowhere/l", "--right", "local:/nowhere/r", "--budget", 1)
        self.assertEqual(refused.returncode, 3, refused.stderr)
        self.assertRegex(refused.stderr, r"paper.toml: the loop does not fit: found \d+ us .* allowed 10; remedy: ")

    @row("the same with `--force`", "it runs, and every recording of it says that `--force` was given")
    def test_force_marks_the_recording(self):
        rig = self.rig(record=True, extra=("--budget", 1, "--force"))
        self.assertEqual(rig.listener.status.admitted, 0)
        self.carries_on(rig)
        rig.end("firmware")
        self.assertEqual(rig.end("recorder"), 0)
        self.assertIn(b"# --force: the loop does not fit", rig.log.read_bytes())
        self.assertIn(b"# --force: the loop does not fit", rig.flight.read_bytes()[:65536])


class Page(unittest.TestCase):
    def test_the_page_is_these_tests(self):
        page = HEAD + "".join(f"| {what} | {ends} | `{name[5:]}` |\n" for what, ends, name in ROWS)
        if os.environ.get("LIGATURE_WRITE_DOCS"):
            PAGE.write_text(page)
        self.assertEqual(PAGE.read_text() if PAGE.exists() else "", page, "old: LIGATURE_WRITE_DOCS=1 writes it anew")


if __name__ == "__main__":
    unittest.main(verbosity=2)
