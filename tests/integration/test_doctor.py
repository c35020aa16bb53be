"""`ligature-firmware doctor` as a program: a report is written, compared and plotted; one that was cut short says so."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

BIN = pathlib.Path(os.environ["LIGATURE_BIN"])
ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(program, *arguments):
    return subprocess.run([BIN / program, *map(str, arguments)], capture_output=True, text=True, timeout=120)


class Doctor(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def plot(self, *reports):
        return run("ligature-host", "plot", reports[0], "--latency", *(("--beside", reports[1]) if len(reports) > 1 else ()),
                   "--out", self.folder / "latency.png")

    def test_a_report_is_compared_and_plotted(self):
        report = self.folder / "a.json"
        told = run("ligature-firmware", "doctor", "--seconds", 0.3, "--report", report)
        self.assertIn(told.returncode, (0, 3), told.stderr)
        self.assertIn("latest wake-up", told.stdout)
        self.assertGreater(json.loads(report.read_text())["wakeup"]["count"], 0)
        self.assertNotIn("   *", run("ligature-firmware", "doctor", "--compare", report, report).stdout, "equal reports differ nowhere")
        drawn = self.plot(report, report)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertEqual((self.folder / "latency.png").read_bytes()[1:4], b"PNG")

    def test_an_acceptance_test_judges_by_scene_drives_and_load(self):
        found = {}
        for device in ("omni", "epos4"):
            report = self.folder / f"{device}.json"
            told = run("ligature-firmware", "doctor", "--hours", 0.0003, "--load", "--scene", ROOT / "scenes/paper.toml",
                       "--device", ROOT / f"scenes/devices/{device}.toml", "--report", report)
            self.assertIn(told.returncode, (0, 3), told.stderr)
            self.assertRegex(told.stdout, "wake-up, this scene +worst .* later than the scene's")
            found[device] = json.loads(report.read_text())
            self.assertEqual([kind.split(":")[0] for kind in found[device]["load"]], ["memory", "cpu", "disk", "network"])
        # The bus leaves 255 us with the drives of omni.toml and 115 us with the EPOS4's, before the loop's computing.
        self.assertLess(found["omni"]["slack_us"], 255)
        self.assertLess(found["epos4"]["slack_us"], 115)

    def test_an_interface_that_is_not_there_fails_the_test(self):
        told = run("ligature-firmware", "doctor", "--seconds", 0, "--can", "nosuchcan", "--report", self.folder / "e.json")
        self.assertEqual(told.returncode, 3, told.stderr)
        self.assertRegex(told.stdout, "FAIL  CAN drivers' time +--can nosuchcan")

    def test_without_a_scene_an_acceptance_test_takes_the_default_scene(self):
        report = self.folder / "d.json"
        told = run("ligature-firmware", "doctor", "--seconds", 0, "--report", report)
        self.assertIn(told.returncode, (0, 3), told.stderr)
        written = json.loads(report.read_text())
        self.assertEqual(written["scene"], "default scene")
        self.assertLess(written["slack_us"], 255)

    def test_a_run_that_was_ended_says_so(self):
        report = self.folder / "b.json"
        command = [BIN / "ligature-firmware", "doctor", "--seconds", "60", "--report", report]
        doctor = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("measuring wake-ups", next(line for line in doctor.stderr if "measuring" in line))
        doctor.send_signal(signal.SIGINT)
        told, _ = doctor.communicate(timeout=120)
        self.assertRegex(told, r"WARN  measured +\d+ s of 60 s")

    def test_a_report_without_a_measurement_is_not_plotted(self):
        report = self.folder / "c.json"
        run("ligature-firmware", "doctor", "--seconds", 0, "--report", report)
        drawn = self.plot(report)
        self.assertNotEqual(drawn.returncode, 0)
        self.assertIn("no wake-up was measured", drawn.stderr)
        self.assertFalse((self.folder / "latency.png").exists())

    def test_drives_are_judged_with_the_watchdog_of_the_run(self):
        asked = ("doctor", "--seconds", 0, "--device", ROOT / "scenes/devices/epos4.toml")
        self.assertIn("for up to 40 ms", run("ligature-firmware", *asked).stdout, "as in the record")
        self.assertIn("for up to 700 ms", run("ligature-firmware", *asked, "--watchdog-ms", 700).stdout)


if __name__ == "__main__":
    unittest.main()
