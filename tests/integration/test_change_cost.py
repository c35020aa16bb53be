"""Fifty live changes while the rig renders force, and fifty quiet seconds between them: the loop loses no more periods in
the first than in the second.

The machine takes periods from the loop, too, in bursts, so periods are no independent draws. Each second with a change is
therefore compared with the quiet second after it, and the interval is that of the mean of fifty differences."""

import pathlib
import statistics
import subprocess
import tempfile
import time
import unittest

from rig import BIN, FLAG_PERIOD_LOST, Rig, STATE_FORCE, run

CHANGES = 50
SURE = 3.3  # standard errors: with as many lost in both, 1 of 1000 runs lies above
HOLDS = """time,hand,x,y,z,grip
0.0,L,0.0,0.0,0.22,0
0.3,L,0.0,0.0,0.22,1
600.0,L,0.0,0.0,0.22,1
0.0,R,0.0,0.0,0.10,0
0.3,R,0.0,0.0,0.10,1
1.3,R,0.0,0.0,0.097,1
600.0,R,0.0,0.0,0.097,1
"""


class LostPeriods(unittest.TestCase):
    def test_fifty_live_changes_under_force(self):
        scratch = tempfile.TemporaryDirectory(prefix="changes-")
        self.addCleanup(scratch.cleanup)
        hands = pathlib.Path(scratch.name) / "holds.csv"
        hands.write_text(HOLDS)
        with Rig(scene="scenes/suture-3-0.toml", operator=hands, extra=("--rt=warn", "--recorder-s", "600")) as rig:
            rig.wait_for(lambda r: r.state_is(STATE_FORCE) and min(r.listener.ticks[-1].grasped_node) >= 0, "force, with both hands' grasps", 120)
            spans = [self.change_and_quiet(i) for i in range(CHANGES)]
            self.assertEqual(rig.end("firmware"), 0, rig.words())
            rows = self.ticks(rig)
        lost = [[self.share_lost(rows, *span) for span in pair] for pair in spans]
        more = [changed - quiet for changed, quiet in lost]
        mean, error = statistics.mean(more), statistics.stdev(more) / CHANGES**0.5
        in_changes, in_quiet = (100 * statistics.mean(pair[i] for pair in lost) for i in (0, 1))
        print(f"periods lost: {in_changes:.3f} % in seconds with a change, {in_quiet:.3f} % in as many quiet ones; more by {100 * mean:.3f}, "
              f"interval {100 * (mean - SURE * error):.3f} .. {100 * (mean + SURE * error):.3f}", flush=True)
        self.assertLessEqual(mean - SURE * error, 0.0, "periods lost by the changes")
        in_force = [r for r in rows if spans[0][0][0] <= r[0] < spans[-1][1][1]]
        self.assertGreater(sum(r[2] == STATE_FORCE for r in in_force), 0.9 * len(in_force))

    def change_and_quiet(self, number):
        """@return beginning and end of a change, at least a second, and of a second without, on the schedule's clock."""
        began = time.monotonic_ns()
        done = run("ligature-host", "send", "set", "contact.friction", f"{0.3 + 0.01 * (number % 5):.2f}")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        time.sleep(max(0.0, 1.0 - 1e-9 * (time.monotonic_ns() - began)))
        ended = time.monotonic_ns()
        time.sleep(1.0)
        return (began, ended), (ended, time.monotonic_ns())

    def ticks(self, rig):
        """Each period as (scheduled time, flags, state)."""
        table = rig.path / "ticks.csv"
        subprocess.run([BIN / "ligature-host", "export", rig.flight, "--ticks", table], check=True, capture_output=True, timeout=300)
        with open(table) as file:
            lines = (line for line in file if not line.startswith("#"))
            names = next(lines).strip().split(",")
            at = [names.index(n) for n in ("scheduled_ns", "flags", "state")]
            return [tuple(int(cells[i]) for i in at) for cells in (line.split(",") for line in lines)]

    def share_lost(self, rows, began, ended):
        flags = [r[1] for r in rows if began <= r[0] < ended]
        self.assertGreater(len(flags), 900, "a second's periods are recorded")
        return sum(f & FLAG_PERIOD_LOST != 0 for f in flags) / len(flags)


if __name__ == "__main__":
    unittest.main()
