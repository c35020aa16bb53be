"""Sutures in the guest: the loop keeps its periods whatever the thread costs, and what the thread loses is recorded."""

import json
import subprocess

from scenario import BIN, CLOCK, CUT, FORCE, LATE, LOST, MISSED, OVERWORKED, pushes, ticks_of

PERIOD_NS = 1_000_000
JITTER_NS = 20_000  # of SYNC: one interrupt, and the calls that send a frame on both buses
USABLE_US = 850


def told(*command):
    done = subprocess.run([BIN / command[0], *command[1:]], capture_output=True, text=True, timeout=600)
    return done.returncode, done.stdout + done.stderr


class Kept:
    """What holds of the loop, however long the physics takes."""

    def the_loop_is_in_time(self, rows):
        self.every_tick_is_there(rows)
        wrong = [{k: r[k] for k in ("tick", "flags", "wakeup_latency_ns", "sync_ns", "tpdo_ns", "law_ns", "control_ns", "execution_ns")}
                 for r in rows if r["flags"] & (LOST | MISSED | OVERWORKED)]
        self.assertEqual(wrong, [], "periods lost, missed deadlines, and ticks with too much work of the loop's own")
        self.assertEqual({b["scheduled_ns"] - a["scheduled_ns"] for a, b in zip(rows, rows[1:])}, {PERIOD_NS})
        syncs = [r["scheduled_ns"] + r["wakeup_latency_ns"] + r["sync_ns"] for r in rows]
        off = max(abs(b - a - PERIOD_NS) for a, b in zip(syncs, syncs[1:]))
        print(f"  SYNC is at most {off / 1e3:.1f} us off a spacing of 1 ms, {len(rows)} periods", flush=True)
        self.assertLess(off, JITTER_NS)
        self.assertEqual({r["fault"] for r in rows}, {0})
        force = [r for r in rows if r["state"] == FORCE]
        self.assertEqual(sum(r["left_tpdo_age_ticks"] + r["right_tpdo_age_ticks"] for r in force), 0, "samples that came too late")
        return force

    @staticmethod
    def lost_share(rows):
        return sum(r["time_lost"] for r in rows) / len(rows)


class SutureInTime(Kept):
    holding = "left",  # hands that hold the thread for a second at least

    def test_no_grasp_is_late(self):
        rows = ticks_of(self.folder / "suture")
        force = self.the_loop_is_in_time(rows)
        print(f"  suture: {100 * self.lost_share(rows):.2f} % of the thread's time lost", flush=True)
        self.assertLess(len(rows) - len(force), 700, "start and end of a run")
        self.assertEqual(sum(r["flags"] & LATE != 0 for r in rows), 0, "late grasps")
        self.assertEqual({r["grasp_age_ticks"] for r in force}, {1})
        for hand in self.holding:
            self.assertGreater(sum(r[f"{hand}_node"] >= 0 for r in force), 1000, f"the {hand} hand holds the thread")

    def test_the_time_that_the_thread_can_use(self):
        code, text = told("ligature-host", "report", self.folder / "suture/suture.lcmlog", "--json")
        self.assertEqual(code, 0, text)
        report = json.loads(text)
        print(f"  time for thread, us: {report['thread']['time_us']}", flush=True)
        self.assertEqual(report["ticks_lost"], 0)
        self.assertGreaterEqual(report["thread"]["time_us"]["min"], USABLE_US)


class TiedSuture(SutureInTime):
    holding = "left", "right"

    def test_the_knot(self):
        """The recorded shapes are knotted, and the same tools give the same shapes outside of the guest."""
        log = self.folder / "suture/suture.lcmlog"
        code, text = told("ligature-host", "knot", log, "--json")
        self.assertEqual((code, json.loads(text)["type"]), (0, "3_1"), text)
        code, text = told("ligature-lab", "rerun", log)
        self.assertEqual(code, 0, text)
        self.assertIn("equal        to the bit", text)


class LargeThread(Kept):
    def test_a_thread_that_is_far_too_large_delays_nothing_and_its_loss_is_told(self):
        rows = ticks_of(self.folder / "large")
        force = self.the_loop_is_in_time(rows)
        pulled = [r for r in force if min(r["left_node"], r["right_node"]) >= 0]
        self.assertLess(len(rows) - len(pulled), 3000, "start and end of a run, and until both hands hold the thread")
        self.assertGreater(sum(map(pushes, pulled)), 1000, "torque went out")
        lost = self.lost_share(rows)
        late = [r for r in rows if r["flags"] & LATE]
        cut = sum(r["flags"] & CUT != 0 for r in rows)
        print(f"  2000 nodes: {100 * lost:.1f} % of the thread's time lost; {cut} ticks ended by the clock, {len(late)} late, "
              f"oldest grasp {max(r['grasp_age_ticks'] for r in force)} periods", flush=True)
        self.assertGreater(lost, 0.1)
        for r in rows:
            self.assertEqual(r["flags"] & CUT != 0, r["thread_end"] == CLOCK and not r["flags"] & LATE)
        summary = (self.folder / "large/firmware.log").read_text()
        self.assertRegex(summary, rf"thread late +{len(late)}\n")
