"""Every program rejects bad input with exit code 2 and one line that names the place, and leaves no partly written
files."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from rig import BIN, ROOT, run

SCENE = (ROOT / "scenes/paper.toml").read_text()
BAD_SCENES = {
    "unknown key": (SCENE.replace("nodes =", "nodez ="), "nodez"),
    "wrong type": (SCENE.replace("length_m = 5.0", 'length_m = "five"'), "length_m"),
    "not a number": (SCENE.replace("radius_m = 0.05", "radius_m = nan"), "radius_m"),
    "too few nodes": (SCENE.replace("nodes = 50", "nodes = 1"), "nodes"),
    "nodes that are no integer": (SCENE.replace("nodes = 50", "nodes = 50.0"), "found 50.0, allowed integer"),
    "not toml": (SCENE + "\n[suture\n", ""),
}
KEYS = (ROOT / "scenes/operators/overhand.csv").read_text()
BAD_GRIPPERS = {
    "short row": KEYS + "21.5,R,0,0\n",
    "not a number": KEYS + "21.5,R,0,0,here,0\n",
    "infinite": KEYS + "21.5,R,0,0,inf,0\n",
    "no such hand": KEYS + "21.5,M,0,0,1,0\n",
    "time goes back": KEYS + "20.0,R,0,0,1,0\n",
    "half a grip": KEYS + "21.5,R,0,0,1,0.5\n",
}


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def refused(self, result, *named):
        """Expects exit code 2 and a single line that contains these words."""
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for word in named:
            self.assertIn(word, result.stderr)

    def programs(self, scene, grippers=ROOT / "scenes/operators/overhand.csv"):
        yield "lab", ("ligature-lab", "run", scene, "--grippers", grippers, "--duration", 0.1, "--out", self.path / "out")
        yield "device", ("ligature-device", "--hand", "left", "--bus", f"local:{self.path}/bus", "--scene", scene, "--operator", grippers)
        yield "firmware", ("ligature-firmware", "run", "--scene", scene, "--left", f"local:{self.path}/l", "--right", f"local:{self.path}/r")

    def test_scenes(self):
        for what, (text, key) in BAD_SCENES.items():
            self.assertNotEqual(text, SCENE, what)
            scene = self.path / "bad.toml"
            scene.write_text(text)
            for name, command in self.programs(scene):
                with self.subTest(scene=what, program=name):
                    self.refused(run(*command), "bad.toml", key)
        self.assertFalse((self.path / "out").exists(), "a refused run left something behind")

    def test_a_coupling_that_the_device_cannot_render(self):
        """Largest passive stiffness at the device: (device damping + coupling damping) / (half a period + delay) = (0.3
        + 0.36) N s/m / 1.5 ms = 440 N/m. Requested: 9000 N/m times the scales, 0.06, = 540 N/m."""
        rig = ("ligature-firmware", "run", "--scene", ROOT / "scenes/paper.toml", "--left", f"local:{self.path}/l", "--right",
               f"local:{self.path}/r", "--set", "hands.coupling_N_per_m=9000")
        self.refused(run(*rig), "hands.coupling_N_per_m", "540 N/m", "440 N/m", "--override-passivity")
        taken = run(*rig, "--override-passivity")  # accepted, and fails at the missing bus
        self.assertEqual(taken.returncode, 3, taken.stderr)
        self.assertIn("bus", taken.stderr)
        self.assertIn("remedy: start the hand", taken.stderr)

    def test_numbers_of_the_simulated_hand(self):
        for option, words in (("--tremor-mm", "0 .. 10"), ("--tremor-hz", "0.1 .. 100"), ("--adversary-s", "0 .. 1"),
                              ("--adversary-mm", "0.1 .. 100"), ("--gravity-share", "0 .. 1")):
            for value in ("nan", "inf", "1e308", "-1"):
                with self.subTest(option=option, value=value):
                    self.refused(run("ligature-device", "--hand", "left", "--bus", f"local:{self.path}/bus", option, value),
                                 option, f"found '{value}'", words)
        for value in ("nan", "9999", "-1"):
            self.refused(run("ligature-device", "--hand", "left", "--bus", f"local:{self.path}/bus", "--cpu", value),
                         "--cpu", f"found '{value}'", "0 .. 1023")

    def test_an_operator_who_ties(self):
        device = ("ligature-device", "--hand", "left", "--bus", f"local:{self.path}/bus")
        scene = ("--scene", ROOT / "scenes/paper.toml")
        self.refused(run(*device, "--operator", "tie:square"), "tie:square", "--scene")
        self.refused(run(*device, *scene, "--operator", "tie:bow:1"), 'found "bow"', "overhand", "surgeon")
        self.refused(run(*device, *scene, "--operator", "tie:square:x"), 'found "x"', "0 .. 4294967295")
        self.refused(run(*device, *scene, "--operator", "tie:surgeon"), "suture.length_m", "6 or more")

    def test_a_missing_scene(self):
        for name, command in self.programs(self.path / "nowhere.toml"):
            with self.subTest(program=name):
                self.refused(run(*command), "nowhere.toml")

    def test_grippers(self):
        for what, text in BAD_GRIPPERS.items():
            script = self.path / "bad.csv"
            script.write_text(text)
            line = str(len(text.splitlines()))
            for name, command in self.programs(ROOT / "scenes/paper.toml", script):
                if name == "firmware":
                    continue  # the firmware reads no script
                with self.subTest(script=what, program=name):
                    self.refused(run(*command), "bad.csv", line)

    def firmware(self, *more, left=None, right=None):
        return run("ligature-firmware", "run", "--scene", "scenes/paper.toml", "--left", left or f"local:{self.path}/l",
                   "--right", right or f"local:{self.path}/r", "--recorder", "none", "--wait-s", "0", "--force", *more)

    def test_firmware_options(self):
        for option, allowed in (("--duration", "0.001 .. 1e+06"), ("--wait-s", "0 .. 3600"), ("--budget", "1 .. 100"),
                                ("--watchdog-ms", "2 .. 10000")):
            for value in ("nan", "inf", "-1"):
                with self.subTest(option=option, value=value):
                    self.refused(run("ligature-firmware", "run", option, value), option, f"found '{value}'", allowed)
        self.refused(self.firmware("--scenes", self.path / "nowhere"), "--scenes", "nowhere")
        self.refused(self.firmware("--lcm-url", "nonsense"), "--lcm-url", "nonsense", "udpm://")
        self.refused(self.firmware("--lcm-url", "udpm://10.0.0.1:7667"), "--lcm-url")
        self.refused(self.firmware("--lcm-url", "udpm://239.255.76.67:nan"), "--lcm-url")
        self.refused(self.firmware(left=f"local:{self.path}/x", right=f"local:{self.path}/../{self.path.name}/x"), "--left", "--right")
        (self.path / "text").write_text("no socket")
        for bad in (f"local:{self.path}", f"local:{self.path}/text", "socketcan:nosuchcan9"):
            with self.subTest(bus=bad):
                self.refused(self.firmware("--no-telemetry", left=bad), bad)

    def test_targets_that_are_no_files(self):
        os.mkfifo(self.path / "pipe")
        os.symlink("pipe", self.path / "link")
        for name in ("pipe", "link"):
            with self.subTest(target=name):
                self.refused(run("ligature-device", "--hand", "left", "--bus", f"local:{self.path}/bus", "--stats", self.path / name), name)
        self.assertTrue((self.path / "pipe").is_fifo())
        self.assertTrue((self.path / "link").is_symlink())
        self.refused(run("ligature-device", "--hand", "left", "--bus", f"local:{self.path}"), "folder")

    def test_empty_names_of_files(self):
        for program, options in (("ligature-firmware run", ("--scene", "--device", "--recorder", "--scenes")),
                                 ("ligature-firmware admit", ("--scene", "--device")),
                                 ("ligature-firmware rehearse", ("--scene", "--text-from")),
                                 ("ligature-firmware doctor", ("--scene", "--device", "--report", "--compare")),
                                 ("ligature-device", ("--scene", "--device", "--operator", "--faults", "--stats"))):
            for option in options:
                with self.subTest(program=program, option=option):
                    second = ("b.json",) if option == "--compare" else ()
                    self.refused(run(*program.split(), option, "", *second), f"{option}: found ''", "allowed a name")

    def test_the_reason_of_a_rehearsal_arrives_in_a_file(self):
        """A rehearsal may write no large file; stderr may be one, with much text in it already."""
        told = self.path / "told"
        for before in (0, 200_000):
            told.write_text("-" * before)
            with open(told, "a") as stderr:
                done = subprocess.run([BIN / "ligature-firmware", "rehearse", "--scene", self.path / "nowhere.toml"], stderr=stderr, timeout=60)
            self.assertEqual(done.returncode, 2)
            self.assertIn("nowhere.toml", told.read_text())

    def test_words_that_are_no_command_or_knot(self):
        self.refused(run("ligature-firmware", "nope"), "nope", "run, admit, rehearse, doctor")
        self.refused(run("ligature-host", "nope"), "nope", "record", "replay")
        self.refused(run("ligature-lab", "nope"), "nope", "run", "pareto")
        self.refused(run("ligature-lab", "tie", "nope"), "nope", "overhand", "surgeon")

    def test_a_full_standard_output(self):
        for program in ("ligature-host", "ligature-lab", "ligature-firmware", "ligature-device", "ligature-can-describe"):
            with self.subTest(program=program), open("/dev/full", "w") as full:
                done = subprocess.run([BIN / program, "--help"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertIn("standard output", done.stderr)

    def test_can_describe(self):
        def fed(command, line):
            return subprocess.run([BIN / "ligature-can-describe", command], input=line + "\n", capture_output=True, text=True, timeout=60)
        self.refused(fed("encode", "rpdo1 1 15 40000"), "torque", "32767")
        self.refused(fed("encode", "tpdo1 1 70000 0 0 0"), "statusword", "65535")
        self.refused(fed("encode", "tpdo1 1 0 3000000000 0 0"), "position")
        self.refused(fed("decode", "181 0011"), "2 bytes", "8")

    def test_host_files(self):
        other = self.path / "other.lcmlog"
        other.write_bytes(os.urandom(5000))
        for command in ("export", "plot", "report"):
            out = {"export": ("--forces", self.path / "f.csv"), "plot": ("--out", self.path / "f.png"), "report": ()}[command]
            with self.subTest(command=command):
                self.refused(run("ligature-host", command, other, *out), "other.lcmlog")
                self.refused(run("ligature-host", command, self.path / "gone.lcmlog", *out), "gone.lcmlog")
        points = self.path / "points.csv"
        points.write_text("x,y,z\n0,0,0\n1,0,zero\n")
        self.refused(run("ligature-host", "knot", points), "points.csv", "3")
        points.write_text("a,b,c\n0,0,0\n1,0,0\n")
        self.refused(run("ligature-host", "knot", points), "points.csv:1", "'a,b,c'", "x,y,z")


if __name__ == "__main__":
    unittest.main(verbosity=2)
