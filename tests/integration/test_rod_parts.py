"""Parts of the rod that a scene does not use are not executed: instructions of ticks by source file, counted by
callgrind.

A loose knot over a desk is pulled with all parts but one. None of that part's code may run, and the tick must cost less
than with it. Counts are by debug lines, so inlined code counts for the file in which it was written."""

import collections
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

LAB = pathlib.Path(os.environ["LIGATURE_BIN"]) / "ligature-lab"
SCENES = pathlib.Path(os.environ["LIGATURE_SOURCE"]) / "scenes"
ROD = "firmware/physics/rod/"
TICKS = 30

# Code that runs only for one part of the rod model: whole files, or single functions.
TWIST = ["twist.cpp"]
ROLL = ["spin.cpp", "spin_frames.cpp", "spin_set.cpp", "turning.cpp"]
CONTACT = ["pair_search.cpp", "contact_collect.cpp", "contact_couplings.cpp", "contact_measure.cpp",
           "contact_places.cpp", "four_segments.hpp", "contact_direct.cpp", "contact_newton.cpp",
           "contact_newton_step.cpp", "contact_metric.cpp", "dense.cpp", "guard.cpp", "mixing.cpp",
           "motion.cpp", "motion.hpp", "smooth.hpp", "touch.hpp"]
ADAPTIVE = ["refine.cpp", "merge_guard.cpp"]
WORLD = re.compile(r"collect_floor|collect_body|afford_world")
DRUM = re.compile(r"collect_body<true>")
RUBS = re.compile(r"settle(_directly)?<true|note_stuck|let_stick")

FULL = ["world.desk_height_m=0.0484"]
# A bar far from the thread, whose surface turns.
TURNS = FULL + ["world.pegs=[{from_m=[0,1,0],to_m=[0,1,1],radius_m=0.01,surface_m_per_s=0.1}]"]
WITHOUT = {
    "twist": ["suture.GJ_N_m2=0"],
    "contact": ['contact.solver="none"'],
    "friction": ["contact.friction=0"],
    "adaptivity": ['suture.spacing="uniform"'],
    "world": [],  # counts() uses a scene without a desk
}


class Counts:
    """Exclusive instruction counts of every file and function called by the ticks."""

    def __init__(self, path):
        self.files, self.functions, self.total = collections.Counter(), collections.Counter(), 0
        names = {"file": {}, "function": {}}

        def name(kind, text):
            number, _, rest = text.partition(" ")
            if rest:
                names[kind][number] = rest
            return names[kind].get(number, text)

        current, function, skip = "", "", False
        for line in path.read_text().splitlines():
            if line.startswith(("fl=", "fi=", "fe=")):
                current = name("file", line[3:])
            elif line.startswith("fn="):
                function = name("function", line[3:])
            elif line.startswith(("cfi=", "cfl=")):
                name("file", line[4:])
            elif line.startswith("cfn="):
                name("function", line[4:])
            elif line.startswith("calls="):
                skip = True  # the next line counts the called function
            elif re.match(r"[+\-*0-9]", line) and len(line.split()) >= 2:
                if not skip:
                    count = int(line.split()[1])
                    self.files[pathlib.PurePath(current).name if ROD in current else current] += count
                    self.functions[function] += count
                    self.total += count
                skip = False


def counts(folder, scene, overrides):
    script = folder / "pull.csv"
    script.write_text("time,hand,x,y,z,grip\n" + "".join(
        f"{t},{hand},{sign * (0.02 + 0.2 * t)},0,0.06,1\n" for hand, sign in (("L", -1), ("R", 1)) for t in (0.0, 0.1)))
    out = folder / "callgrind.out"
    done = subprocess.run(
        ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--toggle-collect=*rod::Rod::tick(*", LAB, "run",
         SCENES / scene, "--grippers", script, "--duration", str(1e-3 * TICKS), "--out", folder / "run"]
        + [word for o in overrides for word in ("--set", o)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return Counts(out)


class Parts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory(prefix="parts-") as name:
            folder = pathlib.Path(name)
            cls.full = counts(folder, "suture-3-0-knot.toml", FULL)
            cls.drum = counts(folder, "suture-3-0-knot.toml", TURNS)
            cls.without = {
                part: counts(folder, "suture-3-0-knot.toml",
                             (["world.grippers_collide=false"] if part == "world" else FULL) + off)
                for part, off in WITHOUT.items()}
            cls.bare = counts(folder, "suture-3-0-knot.toml", [o for off in WITHOUT.values() for o in off])
        for part, c in [("all", cls.full), *cls.without.items(), ("none", cls.bare)]:
            print(f"{part:12} {c.total / TICKS / 1e3:8.0f} thousand instructions a tick")

    def executed(self, counts, files):
        return {f: counts.files[f] for f in files if counts.files[f]}

    def called(self, counts, pattern):
        return [f for f in counts.functions if pattern.search(f)]

    def test_the_parts_of_a_scene_are_executed(self):
        for files in (TWIST, ADAPTIVE):
            self.assertEqual(sorted(self.executed(self.full, files)), sorted(files))
        # Sweeps solve contact with a desk, and Newton's method contact of the thread with itself alone
        executed = {**self.executed(self.full, CONTACT), **self.executed(self.without["world"], CONTACT)}
        self.assertEqual(sorted(executed), sorted(CONTACT))
        self.assertTrue(self.called(self.full, WORLD))
        self.assertTrue(self.called(self.full, RUBS))

    def test_what_is_absent_is_not_executed(self):
        for part, files in (("twist", TWIST + ROLL), ("contact", CONTACT), ("adaptivity", ADAPTIVE)):
            with self.subTest(without=part):
                self.assertEqual(self.executed(self.without[part], files), {})
        for part, functions in (("world", WORLD), ("friction", RUBS)):
            with self.subTest(without=part):
                self.assertEqual(self.called(self.without[part], functions), [])
        with self.subTest(without="drum"):
            self.assertTrue(self.called(self.drum, DRUM))
            self.assertEqual(self.called(self.full, DRUM), [])
        with self.subTest(without="roll, turning, set"):
            self.assertEqual(self.executed(self.full, ROLL), {})
        with self.subTest(without="all"):
            self.assertEqual(self.executed(self.bare, TWIST + ROLL + CONTACT + ADAPTIVE), {})

    def test_a_bare_thread_costs_a_part_of_it(self):
        # Not "friction": without friction more contacts slide, and the solver needs more iterations.
        for part in ("twist", "contact", "adaptivity", "world"):
            self.assertLess(self.without[part].total, self.full.total, part)
        self.assertLess(self.bare.total, 0.4 * self.full.total)


if __name__ == "__main__":
    unittest.main()
