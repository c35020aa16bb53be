"""scripts/sweep repeats the tests that draw, and only those; and whatever draws tells it so."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SWEEP = pathlib.Path(__file__).parents[2] / "scripts/sweep"
TESTS = pathlib.Path(os.environ["LIGATURE_TESTS"])
BUILD = """
add_test(Three.Fails sh -c "echo $LIGATURE_TEST_SEED >> three; ${LIGATURE_TEST_DREW:+touch $LIGATURE_TEST_DREW}; test $LIGATURE_TEST_SEED != 3")
add_test(Same.Always sh -c "echo $LIGATURE_TEST_SEED >> same")
add_test(Same.Serial sh -c "echo $LIGATURE_TEST_SEED >> same")
set_tests_properties(Same.Serial PROPERTIES RUN_SERIAL TRUE)
add_test(Inner.Process sh -c "echo $INNER$LIGATURE_TEST_SEED >> inner; ${LIGATURE_TEST_DREW:+touch $LIGATURE_TEST_DREW}")
set_tests_properties(Inner.Process PROPERTIES ENVIRONMENT INNER=own RESOURCE_LOCK rig)
""".replace("$", "\\$")


class Sweep(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def swept(self, *arguments):
        if not (self.folder / "CTestTestfile.cmake").exists():
            (self.folder / "CTestTestfile.cmake").write_text(BUILD)
        return subprocess.run([SWEEP, "--build", self.folder, "--seeds", "3", *arguments], cwd=self.folder, capture_output=True, text=True)

    def lines(self, name):
        return (self.folder / name).read_text().split()

    def test_repeats_what_draws_and_names_what_fails(self):
        done = self.swept("--first", "2")
        self.assertEqual(done.returncode, 3, done.stderr)
        said = done.stdout.splitlines()
        self.assertEqual(said[0], "2 of 4 tests draw random input, and are repeated")
        self.assertIn("seed 2: 2 of 2 passed", said)
        self.assertIn("seed 3: 1 of 2 passed; not Three.Fails", said)
        self.assertIn("Three.Fails: fails for 1 of 3: 3", said)
        self.assertEqual(self.lines("three"), ["2", "2", "3", "4"], "once to see whether it draws, and once for each seed")
        self.assertEqual(self.lines("same"), ["2", "2"])
        self.assertEqual(self.lines("inner"), ["own2", "own2", "own3", "own4"])

    def test_takes_the_tests_that_it_is_told_to(self):
        self.assertEqual(self.swept("--test", "Inner").returncode, 0)
        self.assertFalse((self.folder / "three").exists())
        done = self.swept("--test", "Nothing")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)

    def test_leaves_out_what_is_slow(self):
        (self.folder / "CTestTestfile.cmake").write_text("""
add_test(Slow.Draws sh -c "touch \\$LIGATURE_TEST_DREW; echo began >> slow; sleep 60; echo ended >> slow")
add_test(Fast.Draws sh -c "\\${LIGATURE_TEST_DREW:+touch \\$LIGATURE_TEST_DREW}")
""")
        done = self.swept("--slowest", "2")
        self.assertEqual(done.stdout.splitlines()[0],
                         "1 of 2 tests draw random input, and are repeated; left out: 1 slower than 2 s, of which 1 draw")
        self.assertEqual((done.returncode, self.lines("slow")), (0, ["began"]))

    def drew(self, *command):
        mark = self.folder / "drew"
        mark.unlink(missing_ok=True)
        subprocess.run(command, env=os.environ | {"LIGATURE_TEST_DREW": str(mark)}, check=True, capture_output=True, cwd=self.folder)
        return mark.exists()

    def test_whatever_draws_tells_so(self):
        program = TESTS / "test_control_headers"
        self.assertTrue(self.drew(program, "--gtest_filter=EncoderWatch.AReversalIsToldTheSoonerTheFaster"))
        self.assertFalse(self.drew(program, "--gtest_filter=EncoderWatch.AGapStartsAnew"))
        path = f"import sys; sys.path.append({str(pathlib.Path(__file__).parent)!r}); from seeds import shifted"
        self.assertTrue(self.drew(sys.executable, "-c", f"{path}; shifted(1)"))
        self.assertFalse(self.drew(sys.executable, "-c", path))


if __name__ == "__main__":
    unittest.main()
