"""The physics asks for the time between pieces of its work, and a piece may take 60 us. This test counts the instructions
of each piece with callgrind.

Counted instead of timed, so that other load has no influence. A shared virtual core executes 8 to 14 million instructions
per millisecond (measured); with 5 million, 300,000 instructions take 60 us."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["LIGATURE_TESTS"]) / "thread-pieces"
SCENES = pathlib.Path(os.environ["LIGATURE_SOURCE"]) / "scenes"
MOST = 300_000


def pieces(scene, ticks, every, *overrides):
    """Instructions of each piece between two queries of the clock, and what the program printed."""
    with tempfile.TemporaryDirectory(prefix="pieces-") as folder:
        out = pathlib.Path(folder) / "out"
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--combine-dumps=yes", "--dump-before=clock_query",
             "--dump-before=pieces_begin", PROGRAM, SCENES / scene, str(ticks), str(every), *overrides],
            capture_output=True, text=True, check=True)
        parts = re.findall(r"^desc: Trigger: (.*?)$.*?^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE | re.DOTALL)
    return [int(count) for trigger, count in parts if "clock_query" in trigger], done.stdout


class Pieces(unittest.TestCase):
    def test_no_piece_of_the_rod_is_long(self):
        # Knots whose ends are pulled. The second has as many nodes as docs/architecture.md states.
        for scene, ticks, every, overrides in (("suture-3-0-surgeons.toml", 120, 40, ()),
                                               ("suture-3-0-knot.toml", 30, 10, ("suture.nodes=500",))):
            with self.subTest(scene=scene, overrides=overrides):
                counts, said = pieces(scene, ticks, every, *overrides)
                print(f"{scene} {' '.join(overrides)}: {len(counts)} pieces, the longest of {max(counts)} instructions; {said.strip()}")
                self.assertEqual(len(counts), int(said.split()[0]), "callgrind counted each piece")
                self.assertGreater(len(counts), 300)
                self.assertGreater(int(said.split()[2]), 5, "contacts")
                self.assertGreater(sum(counts), 5 * MOST, "the pieces are the work of these ticks")
                self.assertLess(max(counts), MOST)


if __name__ == "__main__":
    unittest.main()
