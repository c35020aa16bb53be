"""Tests in the guest. Each class boots it once; the results are evaluated on the host (scenario.py)."""

import json
import os
import unittest

from blows import Blows, FirstBlows, OtherBlows
from scenario import AS_FAST_AS_A_RIG, FORCE, LOST, MISSED, OUT, ROOT, VIRTUAL, Guest, Scenario, guest, pushes, ticks_of
from sutures import LargeThread, SutureInTime, TiedSuture

PAGE = ROOT / "docs/measurements/fault-matrix-guest.md"
PAGE_HEAD = """# Fault matrix, guest

This page shows what real processes over SocketCAN do when something fails. `scripts/test-hil Faults` makes the page,
with a PREEMPT_RT kernel in an emulator (the guest) in virtual time ([timing](timing.md)). Each event happens half a
second after the coupling has reached its full force. Ticks of 1 ms are counted by SYNC in `candump` and in the flight
recorder; tick 0 is the one in which the event is on the bus. After the fault no record and no RPDO (torque message) of
either hand has a torque. *Stated* is what the test requires; *seen* is from the run that wrote this page.

| what happens | stated | seen |
|---|---|---|
"""
DISK_BYTES = 128 << 20


class Deadlines:
    def test_ten_seconds_at_1_kHz_without_a_missed_deadline(self):
        rows = ticks_of(self.folder / "overhand")
        self.every_tick_is_there(rows)
        self.assertGreaterEqual(len(rows), 10_000)
        late = [{k: r[k] for k in ("tick", "state", "wakeup_latency_ns", "sync_ns", "tpdo_ns", "law_ns", "control_ns", "execution_ns")}
                for r in rows if r["flags"] & MISSED]
        self.assertEqual(late, [], "missed deadlines")
        self.assertEqual(sum(r["flags"] & LOST != 0 for r in rows), 0, "overruns")
        self.assertEqual({r["fault"] for r in rows}, {0})
        self.assertGreater(sum(r["state"] == FORCE for r in rows), 9_000)
        self.assertGreater(sum(map(pushes, rows)), 9_000, "torque went out")
        started = [r for r in rows if r["state"] == FORCE]
        self.assertEqual(sum(r["left_tpdo_age_ticks"] + r["right_tpdo_age_ticks"] for r in started), 0, "samples that came too late")
        for what in ("wakeup_latency_ns", "tpdo_ns", "control_ns", "execution_ns"):
            values = sorted(r[what] for r in started)
            print(f"  {what:18} p50 {values[len(values) // 2] / 1e3:6.1f}  p99.9 {values[-len(values) // 1000] / 1e3:6.1f}  worst {values[-1] / 1e3:6.1f} us")
        print(f"  {len(rows)} periods, {len(started)} in FORCE, 0 missed, 0 lost", flush=True)


class Overhand(Deadlines, Scenario):
    name = "overhand"


class Suture(TiedSuture, Scenario):
    name = "suture"
    time = AS_FAST_AS_A_RIG


class Large(LargeThread, Scenario):
    name = "large"
    time = AS_FAST_AS_A_RIG


class LargeMinute(LargeThread, Scenario):
    name = "large_minute"
    time = (*VIRTUAL, "--per-ns", "2")  # with 1 the loop's own work, up to 381 us of CPU, does not fit its 255 us


class Faults(FirstBlows, OtherBlows, Blows):
    name = "faults"
    rows = {}

    @classmethod
    def tearDownClass(cls):
        """Compares the page's stated reactions with this run's; the observed values on the page are from the run that
        wrote it."""
        made = PAGE_HEAD + "".join(f"| {what} | {stated} | {seen} |\n" for _, (what, stated, seen) in sorted(cls.rows.items()))
        if os.environ.get("LIGATURE_WRITE_DOCS"):
            PAGE.write_text(made)
        without_seen = [[line.rsplit("|", 2)[0] for line in text.splitlines()] for text in (PAGE.read_text() if PAGE.exists() else "", made)]
        assert without_seen[0] == without_seen[1], f"{PAGE.name} is old: LIGATURE_WRITE_DOCS=1 writes it anew"


class Short(Deadlines, FirstBlows, Blows):
    """The short form for every change, in one boot."""
    name = "short"
    rows = {}


class ShortSuture(SutureInTime, Scenario):
    name = "short_suture"
    time = AS_FAST_AS_A_RIG


class ShelfDrives(Scenario):
    name = "shelf_drives"
    time = AS_FAST_AS_A_RIG  # six requests a period, each with a wake-up of a hand, take a quarter of a period with one

    def runs(self, suffix=""):
        return [(drives, self.folder / (drives + suffix)) for drives in ("odrive", "moteus")]

    def test_no_sample_is_late_and_no_deadline_missed(self):
        for drives, folder in self.runs():
            rows = ticks_of(folder)
            self.every_tick_is_there(rows)
            force = [r for r in rows if r["state"] == FORCE]
            print(f"  {drives}: {len(rows)} periods, {len(force)} in FORCE", flush=True)
            self.assertGreater(len(force), 500)
            self.assertTrue(any(map(pushes, force)))
            self.assertEqual({r["fault"] for r in rows}, {0})
            self.assertEqual(sum(r["flags"] & (LOST | MISSED) != 0 for r in rows), 0)
            self.assertEqual(sum(r["left_tpdo_age_ticks"] + r["right_tpdo_age_ticks"] for r in force), 0)

    def test_every_drive_ends_its_command_when_the_firmware_is_killed(self):
        for drives, folder in self.runs("-killed"):
            for hand in ("left", "right"):
                stats = json.loads((folder / f"{hand}.json").read_text())
                self.assertEqual(stats["watchdog_trips"], 6, "each drive at start-up, which tries it, and at the end")
                most = 0 if drives == "odrive" else 340  # moteus drives damp the motion, with 0.1 N m at most
                self.assertLessEqual(max(map(abs, stats["final_torque_permille"])), most)


class Canopen(Guest):
    def test_python_canopen_is_the_master_of_a_hand(self):
        _, code = guest("canopen_master")
        self.assertEqual(code, 0)

    def test_python_canopen_is_a_slave_of_the_firmware(self):
        folder, code = guest("canopen_slave", *VIRTUAL)
        self.assertEqual(code, 0)
        told = json.loads((folder / "canopen-slave/canopen.json").read_text())
        self.assertGreater(told["syncs"], 500)
        self.assertGreater(told["heartbeats"], 10)
        for drive in told["drives"]:
            node = drive["node"]
            written = {(index, sub): value for index, sub, value in drive["written"]}
            self.assertEqual(written[(0x6060, 0)], 10, "cyclic synchronous torque")
            self.assertEqual(written[(0x1400, 5)], 10_000, "RPDO watchdog as asked for")
            self.assertEqual(written[(0x1016, 1)] >> 16, 127)
            self.assertEqual(drive["nmt_while_written"], ["PRE-OPERATIONAL"])
            last = [0x2100, 1, 16] if node == 3 else [0x6077, 0, 16]
            self.assertEqual(drive["map"], {"cob_id": 0x180 + node, "type": 1, "map": [[0x6041, 0, 16], [0x6064, 0, 32], last]})
            self.assertGreater(drive["rpdos"], 300)
            self.assertEqual(drive["torque_at_end"], 0, "after the EMCY")
        self.assertGreater(max(d["torque_before"] for d in told["drives"]), 0, "the thread pulled at the slow hand")
        rows = ticks_of(folder / "canopen-slave")
        self.every_tick_is_there(rows)
        self.assertEqual({r["fault"] for r in rows}, {0, 12})
        self.assertEqual(sum(r["flags"] & (LOST | MISSED) != 0 for r in rows), 0)


class Power(Guest):
    def test_a_power_cut_takes_less_than_a_second(self):
        disk = OUT / "disk.ext4"
        OUT.mkdir(parents=True, exist_ok=True)
        with open(disk, "wb") as made:
            made.truncate(DISK_BYTES)
        cut, code = guest("power_cut", *VIRTUAL, "--disk", str(disk))
        self.assertEqual(code, 0)
        back, code = guest("power_back", *VIRTUAL, "--disk", str(disk))
        self.assertEqual(code, 0)
        written, synced = ticks_of(cut / "power-cut"), ticks_of(back / "power-back")
        self.assertEqual((written[-1]["state"], pushes(written[-1])), (FORCE, True), "the cut must find the rig in force")
        self.assertEqual(synced, written[:len(synced)], "what is there is what was")
        lost = len(written) - len(synced)
        print(f"  {len(written)} ticks written, the last {lost} lost with the power", flush=True)
        self.assertLess(lost, 1000)


class Machine(Guest):
    def test_back_ends_doctor_and_enforce(self):
        folder, code = guest("machine", "--cpus", "2", "--isolate")
        self.assertEqual(code, 0)
        ran = (folder / "socketcan.log").read_text()
        self.assertIn("[  PASSED  ] 10 tests", ran)
        rows = (folder / "doctor.log").read_text()
        for row in ("OK    kernel .*PREEMPT_RT", "OK    own core .*core 1", "OK    timer ticks .*core 1", "OK    RCU callbacks",
                    "OK    real-time priority", "OK    locked memory", "OK    LCM", "OK    CAN +vcan0: up", "OK    CAN bit rate .*virtual",
                    "OK    CAN bit rate .*can0: 1e\\+06 bit/s, sample point 0.75", "wake-ups",
                    r"hardware gaps +(none above|gaps of up to) .*tracer hwlat",
                    r"OK    latest wake-up +\d+ us late, the timer's interrupt \d+ us.*(took|it interrupted \w+)"):
            self.assertRegex(rows, row)
        self.assertRegex(rows, "OK    real-time share")
        self.assertRegex(rows, "wake-up, this scene")
        if (fair_server := folder / "fair_server.log").exists():  # Linux 6.12 and later
            self.assertRegex(fair_server.read_text(), "WARN  real-time share +the fair server may take 50000000 ns")
        self.assertIn((folder / "doctor.code").read_text().strip(), ("0", "3"), "3: an emulated machine is late")
        self.assertRegex((folder / "admit.log").read_text(), r"calls to both buses .* [0-9.]+ of them in the drivers of vcan0, can0, whose delay of \d+ us")
        self.assertEqual((folder / "enforce.code").read_text().strip(), "3")
        self.assertRegex((folder / "enforce.log").read_text(), "--rt=enforce: .*(SCHED_FIFO|locked memory)")


if __name__ == "__main__":
    unittest.main(verbosity=1)
