"""Every program on CPUs that lack instructions of its build: exit code 3 and one line that names them and the remedy; and
no program of the build for CPUs without AVX contains an instruction that such a CPU lacks.

Usage: test_cpu.py LIGATURE_ARCH; LIGATURE_BIN: folder of the programs, beside that of the test programs"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

BIN = os.environ["LIGATURE_BIN"]
PROGRAMS = ("ligature-firmware", "ligature-device", "ligature-host", "ligature-lab", "ligature-bridge", "ligature-can-describe")
# CPUs of QEMU; for each the builds (LIGATURE_ARCH) that cannot run on it, with the first missing feature.
LACKING = {"Nehalem": {"default": "avx", "x86-64-v3": "avx"}, "qemu64": {"default": "avx", "x86-64-v2": "ssse3"}}
# What GCC may use for x86-64-v3 but not for x86-64-v2: AVX and FMA (all begin with v and name a vector register), BMI,
# LZCNT and MOVBE. (TZCNT is no mistake: older CPUs execute it as BSF, and GCC uses it only where both agree.)
NOT_V2 = re.compile(r"\t(v[a-z0-9]+ .*%[xyz]mm|(andn|bextr|bls(i|r|msk)|bzhi|mulx|pdep|pext|rorx|s[ah][lr]x|lzcnt|movbe)[lqw]? )")


def version_on(cpu, program):
    return subprocess.run(["qemu-x86_64", "-cpu", cpu, os.path.join(BIN, program), "--version"],
                          capture_output=True, text=True, timeout=60)


class Cpu(unittest.TestCase):
    arch = "default"

    def test_what_it_lacks_is_said(self):
        self.assertIsNotNone(shutil.which("qemu-x86_64"), "remedy: scripts/setup test")
        for cpu, builds in LACKING.items():
            for program in PROGRAMS:
                with self.subTest(cpu=cpu, program=program):
                    got = version_on(cpu, program)
                    missing = builds.get(self.arch)
                    if missing is None:
                        self.assertEqual(got.returncode, 0, got.stderr)
                        continue
                    self.assertEqual(got.returncode, 3, got.stderr)
                    lines = [line for line in got.stderr.splitlines() if not line.startswith("qemu-x86_64: warning")]
                    self.assertEqual(len(lines), 1, got.stderr)
                    self.assertRegex(lines[0], rf"^{program}: this CPU lacks.* {missing}\b.*remedy: ")

    def test_contains_only_what_it_may(self):
        if self.arch in ("default", "x86-64-v3"):
            self.assertTrue(any_not_v2(os.path.join(BIN, "ligature-firmware")), "the search must find AVX in this build")
        if self.arch != "x86-64-v2":
            return
        files = [path for folder in ("bin", "tests") for path in (pathlib.Path(BIN).parent / folder).iterdir()]
        for program in sorted(path for path in files if path.is_file() and os.access(path, os.X_OK)):
            with self.subTest(program=program.name):
                self.assertEqual(any_not_v2(program), "")


def any_not_v2(program):
    """The first instruction that x86-64-v2 lacks, as objdump prints it, or nothing."""
    with subprocess.Popen(["objdump", "-d", "--no-show-raw-insn", program], stdout=subprocess.PIPE, text=True) as dump:
        found = next((line for line in dump.stdout if NOT_V2.search(line)), "")
        dump.kill()
    return found


if __name__ == "__main__":
    Cpu.arch = sys.argv.pop(1)
    unittest.main()
