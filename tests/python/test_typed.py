"""The type stubs, as a type checker of a user reads them."""

import os
import pathlib
import subprocess
import sys

import ligature

PACKAGE = pathlib.Path(ligature.__file__).parent.parent


def test_mypy_finds_what_is_wrong_and_nothing_else(tmp_path):
    program = pathlib.Path(__file__).parent / "typed_use.py"
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir", tmp_path, program],
                          env=os.environ | {"MYPYPATH": str(PACKAGE)}, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (PACKAGE / "ligature/py.typed").exists()  # without it, type checkers do not read an installed package
