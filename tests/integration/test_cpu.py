"""Every program on CPUs that lack instructions of its build: exit code 3 and one line that names them and the remedy.
"""

import os
import shutil
import subprocess
import sys
import unittest

BIN = os.environ["LIGATURE_BIN"]
PROGRAMS = ("ligature-firmware", "ligature-device", "ligature-host", "ligature-lab", "ligature-bridge", "ligature-can-describe")
# CPUs of QEMU; for each the builds (LIGATURE_ARCH) that cannot run on it, with the first missing feature.
LACKING = {"Nehalem": {"default": "avx", "x86-64-v3": "avx"}, "qemu64": {"default": "avx", "x86-64-v2": "ssse3"}}


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


if __name__ == "__main__":
    Cpu.arch = sys.argv.pop(1)
    unittest.main()
