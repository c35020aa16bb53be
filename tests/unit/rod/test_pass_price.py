"""The price of a pass over contacts (rod/work.hpp) against its instructions as counted by callgrind.

Two runs of one substep differ only in the number of passes, so the difference is the cost of passes alone. The price
follows from the time of a pass, in which each row waits for the result of the row before, so it is above the number of
instructions. Of 30 random balls of thread (16 to 115 contacts) the price was 0.95 to 1.25 of the instructions, on
average 1.10, with a standard deviation of 0.085."""

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
    def test_a_pass_costs_its_price(self):
        ratios = []
        for seed in (1, 2, 3, 4):
            few, many = counted(seed, FEW), counted(seed, MANY)
            self.assertEqual(many[2] - few[2], MANY - FEW)
            self.assertGreater(many[3], 15)
            cost, price = (many[0] - few[0]) / (MANY - FEW), (many[1] - few[1]) / (MANY - FEW)
            print(f"seed {seed}, {many[3]} contacts: a pass costs {cost:,.0f} instructions, its price is {price:,.0f}: {price / cost:.2f}")
            ratios.append(price / cost)
        self.assertGreater(min(ratios), 0.7)
        self.assertLess(max(ratios), 1.6)
        mean = sum(ratios) / len(ratios)
        self.assertTrue(0.85 < mean < 1.35, f"six standard errors from the mean above, but it is {mean:.2f}")


if __name__ == "__main__":
    unittest.main()
