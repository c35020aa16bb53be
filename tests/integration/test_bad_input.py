"""Every program refuses bad input with exit 2 and one line that names the place; nothing half-written stays."""

import os
import pathlib
import tempfile
import unittest

from rig import ROOT, run

SCENE = (ROOT / "scenes/paper.toml").read_text()
BAD_SCENES = {
    "unknown key": (SCENE.replace("nodes =", "nodez ="), "nodez"),
    "wrong type": (SCENE.replace("length_m = 5.0", 'length_m = "five"'), "length_m"),
    "not a number": (SCENE.replace("radius_m = 0.05", "radius_m = nan"), "radius_m"),
    "too few nodes": (SCENE.replace("nodes = 50", "nodes = 1"), "nodes"),
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
        """Exit 2, one line, and the line says these words."""
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
                    continue  # it reads no script
                with self.subTest(script=what, program=name):
                    self.refused(run(*command), "bad.csv", line)

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


if __name__ == "__main__":
    unittest.main(verbosity=2)
