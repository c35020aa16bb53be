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
        report.write_text("old")
        command = [BIN / "ligature-firmware", "doctor", "--seconds", "60", "--report", report]
        doctor = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("measuring wake-ups", next(line for line in doctor.stderr if "measuring" in line))
        self.assertEqual(report.read_text(), "old", "an old report stays until the new one is complete")
        doctor.send_signal(signal.SIGINT)
        told, _ = doctor.communicate(timeout=120)
        self.assertRegex(told, r"WARN  measured +\d+ s of 60 s")
        self.assertIn("verdict", json.loads(report.read_text()))
        self.assertEqual([p.name for p in self.folder.iterdir()], ["b.json"])

    def test_a_report_that_cannot_be_written_is_refused_before_the_measurement(self):
        os.mkfifo(self.folder / "pipe")
        os.symlink("pipe", self.folder / "link")
        os.symlink("nowhere", self.folder / "loose")
        for target in ("pipe", "link", "loose", ".", "none/a.json"):
            told = run("ligature-firmware", "doctor", "--seconds", 0, "--report", self.folder / target)
            self.assertEqual(told.returncode, 2, told.stderr)
            self.assertEqual(told.stdout, "", target)
            self.assertIn(f"--report {self.folder / target}: ", told.stderr)
        self.assertTrue((self.folder / "pipe").is_fifo())
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["link", "loose", "pipe"])

    def test_a_report_is_written_through_a_link(self):
        (self.folder / "real.json").write_text("old")
        os.symlink("real.json", self.folder / "link.json")
        run("ligature-firmware", "doctor", "--seconds", 0, "--report", self.folder / "link.json")
        self.assertTrue((self.folder / "link.json").is_symlink())
        self.assertIn("verdict", json.loads((self.folder / "real.json").read_text()))

    def test_a_file_that_is_no_report_is_named(self):
        whole = {"format": "ligature doctor 1", "wakeup": {"count": 3}}
        for name, text in (("text", "x,y,z\n"), ("other", "{}"), ("half", json.dumps(whole))):
            (self.folder / name).write_text(text)
            drawn = self.plot(self.folder / name)
            self.assertEqual(drawn.returncode, 2, drawn.stderr)
            self.assertRegex(drawn.stderr, rf"^ligature-host: {self.folder / name}: found .*\n$")
        self.assertFalse((self.folder / "latency.png").exists())

    def test_a_report_without_a_measurement_is_not_plotted(self):
        report = self.folder / "c.json"
        run("ligature-firmware", "doctor", "--seconds", 0, "--report", report)
        drawn = self.plot(report)
        self.assertEqual(drawn.returncode, 2)
        self.assertIn("no wake-up was measured", drawn.stderr)
        self.assertFalse((self.folder / "latency.png").exists())

    def test_drives_are_judged_with_the_watchdog_of_the_run(self):
        asked = ("doctor", "--seconds", 0, "--device", ROOT / "scenes/devices/epos4.toml")
        self.assertIn("for up to 40 ms", run("ligature-firmware", *asked).stdout, "as in the record")
        self.assertIn("for up to 700 ms", run("ligature-firmware", *asked, "--watchdog-ms", 700).stdout)


if __name__ == "__main__":
    unittest.main()
