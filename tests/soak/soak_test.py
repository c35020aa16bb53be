"""How the soak judges ticks that were charged too much CPU time, by the same for its witness. Usage: soak_test.py"""

import math

from soak import chance, judge_by_witness

TOLD = "600000 40.0 41.0 900.0 {}\n"  # periods, least, median and worst us, number above the limit
COMPUTED_NS = 600_000 * 40e3  # as much as the witness

assert chance(0, 7, 0.5) == 1.0
assert math.isclose(chance(3, 0, 0.5), 0.125)
assert math.isclose(chance(1, 1, 0.25), 1 - 0.75**2)
assert judge_by_witness(0, COMPUTED_NS, TOLD.format(0)) is None
assert judge_by_witness(8, COMPUTED_NS, TOLD.format(6)) is None, "the machine does this to both"
assert "8 ticks worked for too long, 0 of the witness" in judge_by_witness(8, COMPUTED_NS, TOLD.format(0))
assert judge_by_witness(12, 10 * COMPUTED_NS, TOLD.format(1)) is None, "who computes longer is robbed more often"
assert judge_by_witness(12, COMPUTED_NS, TOLD.format(1)) is not None
print("soak: long ticks are judged by the witness")
