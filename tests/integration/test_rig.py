"""The whole rig as separate processes: it ties a knot, and the death of any single process leaves no torque."""

import json
import math
import sys
import unittest

from rig import FLAG_PERIOD_LOST, HANDS, STATE_ENGAGE, STATE_FAULT, STATE_FORCE, Rig, run

MAX_FORCE_N = 3.3


def torque_of(tick):
    return [t for hand in tick.torque_permille for t in hand]


def pushes_both_hands(rig):
    """Whether the rig is in state FORCE with torque on both hands, so that there is something for a fault to remove."""
    return rig.state_is(STATE_FORCE) and all(any(hand) for hand in rig.listener.ticks[-1].torque_permille)


class WholeRig(unittest.TestCase):
    SESSIONS = 3  # at most: a machine that other programs use may stand still during one

    def session(self):
        """Results of a whole session, or None if the machine stood still during it and a simulated hand jumped."""
        with Rig(record=True, extra=("--duration", 23)) as rig:
            code = rig.processes["firmware"].wait(timeout=120)
            if rig.jumped_in_a_stall():
                print(rig.words(), file=sys.stderr)
                return None
            self.assertEqual(code, 0, rig.words())
            self.assertEqual(rig.end("recorder"), 0, rig.words())
            report = json.loads(run("ligature-host", "report", rig.log, "--json").stdout)
            knot = json.loads(run("ligature-host", "knot", rig.log, "--json").stdout)
            picture = rig.path / "knot.svg"
            self.assertEqual(run("ligature-host", "plot", rig.log, "--thread", "--out", picture).returncode, 0)
            self.assertIn("3_1 right, overhand", picture.read_text())
            forces = rig.path / "forces.csv"
            self.assertEqual(run("ligature-host", "export", rig.log, "--forces", forces).returncode, 0)
            rows = [line for line in forces.read_text().splitlines() if line and not line.startswith("#")][1:]
            return knot, report, rows, rig.listener.ticks

    def test_ties_the_overhand_and_every_tick_is_recorded(self):
        session = next(filter(None, (self.session() for _ in range(self.SESSIONS))), None)
        self.assertIsNotNone(session, "a simulated hand jumped in every session")
        knot, report, rows, ticks = session
        self.assertEqual(knot["type"], "3_1")
        self.assertEqual(report["ticks_lost"], 0)
        self.assertEqual(report["ticks_recorded"], len(rows))
        # One row per period, including lost periods and the fade-out of the force at the end.
        self.assertAlmostEqual(len(rows), 23000, delta=100)
        numbers = [t.tick for t in ticks]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))), "an independent listener saw a hole")
        magnitudes = [math.hypot(*t.f_device_N[h]) for t in ticks for h in (0, 1)]
        self.assertLessEqual(max(magnitudes), MAX_FORCE_N * (1 + 1e-9))
        self.assertGreater(max(magnitudes), 0.01, "the hands felt nothing")


class Deaths(unittest.TestCase):
    def test_a_dead_hand_faults_the_firmware_and_frees_the_other(self):
        for victim in HANDS:
            with self.subTest(victim=victim), Rig() as rig:
                rig.wait_for(pushes_both_hands, "force on both hands")
                rig.kill(victim)
                rig.wait_for(lambda r: r.state_is(STATE_FAULT), "the fault")
                rig.wait_for(lambda r: r.listener.status is not None and r.listener.status.fault != 0, "a status with the fault")
                executed = [t for t in rig.listener.ticks if t.state == STATE_FAULT and not t.flags & FLAG_PERIOD_LOST]
                self.assertTrue(all(t == 0 for tick in executed for t in torque_of(tick)), "torque in a faulted tick")
                self.assertTrue(rig.alive("firmware"))
                survivor = HANDS[1 - HANDS.index(victim)]
                self.assertEqual(rig.device_stats(survivor)["final_torque_permille"], [0, 0, 0])
                self.assertEqual(rig.end("firmware"), 3, rig.words())

    def test_a_dead_recorder_does_not_disturb_the_firmware(self):
        with Rig(record=True) as rig:
            rig.wait_for(pushes_both_hands, "force on both hands")
            rig.kill("recorder")
            seen = rig.listener.ticks[-1].tick
            rig.wait_for(lambda r: r.listener.ticks[-1].tick > seen + 500, "another 500 ticks")
            self.assertTrue(rig.state_is(STATE_FORCE))
            self.assertEqual(run("ligature-host", "export", rig.log, "--forces", rig.path / "f.csv").returncode, 0)
            self.assertEqual(rig.end("firmware"), 0, rig.words())

    def test_a_dead_firmware_leaves_the_drives_without_torque_and_a_new_one_can_start(self):
        with Rig() as rig:
            rig.wait_for(pushes_both_hands, "force on both hands")
            rig.kill("firmware")
            session = rig.listener.status.session
            rig.start_firmware()
            rig.wait_for(lambda r: r.listener.status.session != session and r.listener.status.state == STATE_ENGAGE,
                         "a second firmware on the same hands")
            self.assertEqual(rig.end("firmware"), 0, rig.words())
            for hand in HANDS:
                stats = rig.device_stats(hand)
                self.assertEqual(stats["final_torque_permille"], [0, 0, 0])

    def test_drives_zero_torque_by_their_own_watchdog(self):
        with Rig(watchdog_ms=300) as rig:
            rig.wait_for(pushes_both_hands, "force on both hands")
            rig.kill("firmware")
            for hand in HANDS:
                rig.wait_for(lambda r: "drives took their torque away" in r.said(hand), f"the watchdog of the {hand} drives")
            for hand in HANDS:
                stats = rig.device_stats(hand)
                self.assertEqual(stats["final_torque_permille"], [0, 0, 0])
                self.assertGreaterEqual(stats["watchdog_trips"], 3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
