"""Runs scenarios in the guest and reads their results: the flight recorder, which holds every tick, and the log of
candump, which shares no code with this project.

Time in the guest is virtual (-icount): an instruction takes 1 ns, and waiting takes no real time. A deadline is
therefore a property of the program and can be asserted."""

import csv
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BIN = pathlib.Path(os.environ["LIGATURE_BIN"])
ARM64 = "LIGATURE_HIL_ARM64" in os.environ  # guest and programs are of arm64
OUT = pathlib.Path(os.environ.get("LIGATURE_HIL_OUT", ROOT / ("build/hil/arm64" if ARM64 else "build/hil")))
LOST, MISSED, OVERWORKED, LATE, CUT = 1, 2, 128, 256, 512
CLOCK = 2  # thread_end: ended by the clock
IDLE, ENGAGE, FORCE, FAULT = 2, 3, 4, 6
LONGEST_S = 4000  # real time on a loaded machine; on an idle one a scenario takes one to four minutes


def guest(name, *options, timeout=LONGEST_S):
    """Runs one scenario. @return the folder with its results, and the exit code."""
    out = OUT / name
    if os.environ.get("LIGATURE_HIL_JUDGE_ONLY"):  # evaluate the results of the last run
        return out, 0
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    began = time.monotonic()
    if ARM64:
        options = ("--arm64", *options)
    print(f"hil: {name} ..", flush=True)
    with open(out / "guest.log", "w") as log:
        process = subprocess.Popen([sys.executable, HERE / "guest.py", "--out", out, "--timeout", str(timeout), *options, "--",
                                    "bash", f"tests/hil/inside/{name}.sh"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        with process.stdout as lines:
            for line in lines:
                log.write(line)
                print("  " + line, end="", flush=True)
        code = process.wait()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"hil: {name}: exit {code}, {time.monotonic() - began:.0f} s, {used.ru_utime + used.ru_stime:.0f} s of CPU so far", flush=True)
    return out, code


VIRTUAL = ("--icount", "0")
AS_FAST_AS_A_RIG = (*VIRTUAL, "--per-ns", "5")  # 5 million instructions per ms, as the physics assumes of a rig's core


def program(name):
    """Command that runs one of the guest's programs on this machine."""
    return [*(["qemu-aarch64", "-L", ROOT / "build/arm64/root"] if ARM64 else []), BIN / name]


def ticks_of(folder, recorded="flight.rec"):
    """The flight recorder's file, or the copy saved at a fault, as a list of rows."""
    made = folder / f"{recorded}.csv"
    subprocess.run([*program("ligature-host"), "export", folder / recorded, "--ticks", made], check=True, capture_output=True, timeout=120)
    with open(made) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [{k: float(v) if "." in v or "e" in v else int(v) for k, v in row.items()} for row in rows]


def pushes(row):
    return any(row[f"{hand}_torque_{joint}_permille"] for hand in ("left", "right") for joint in (1, 2, 3))


def wire_of(folder, by_time=False):
    """candump's log as (interface, identifier, data), in its order, which is correct within each bus, or sorted by the
    kernel's time stamps."""
    line_of = re.compile(r"\((\d+\.\d+)\) +(\S+) ([0-9A-F]+)#([0-9A-F]*)")
    lines = [m for m in map(line_of.match, (folder / "can.log").read_text().splitlines()) if m]
    if by_time:
        lines.sort(key=lambda m: float(m[1]))
    return [(m[2], int(m[3], 16), bytes.fromhex(m[4])) for m in lines]


class Guest(unittest.TestCase):
    def every_tick_is_there(self, rows):
        self.assertEqual([r["tick"] for r in rows], list(range(len(rows))))


class Scenario(Guest):
    """Base class of tests that share one boot of the guest, in which the scenario `name` runs."""
    name = None
    time = VIRTUAL

    @classmethod
    def setUpClass(cls):
        cls.folder, cls.code = guest(cls.name, *cls.time)

    def setUp(self):
        self.assertEqual(self.code, 0, f"the guest's scenario {self.name}")
