"""The price of a pass over contacts (rod/work.hpp) against its instructions as counted by callgrind.

Two runs of one substep differ only in the number of passes, so the difference is the cost of passes alone. The bound on
a tick's time requires price >= cost; a much higher price would leave budget unused."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["LIGATURE_BIN"]) / "rod-one-tick"
FEW, MANY = 4, 24


def counted(seed, passes):
    """@return instructions, work charged, passes made, contacts"""
    with tempfile.NamedTemporaryFile() as out:
        done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out.name}", PROGRAM, str(seed), str(passes)],
                              capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1)), *map(int, done.stdout.split())


class PassPrice(unittest.TestCase):
    def test_a_pass_costs_no_more_than_its_price(self):
        for seed in (1, 2):
            few, many = counted(seed, FEW), counted(seed, MANY)
            self.assertEqual(many[2] - few[2], MANY - FEW)
            cost, price = (many[0] - few[0]) / (MANY - FEW), (many[1] - few[1]) / (MANY - FEW)
            print(f"seed {seed}, {many[3]} contacts: a pass costs {cost:,.0f} instructions, its price is {price:,.0f}: {price / cost:.2f}")
            self.assertGreater(many[3], 50)
            self.assertGreater(price, 0.8 * cost)  # prices are for release builds; this build has asserts
            self.assertLess(price, 1.7 * cost)


if __name__ == "__main__":
    unittest.main()
