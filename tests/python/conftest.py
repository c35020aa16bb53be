"""Shared by the tests of the Python package: source tree, programs, gripper scripts."""

import os
import pathlib
import subprocess
import sys

import pytest

import ligature

SOURCE = pathlib.Path(os.environ["LIGATURE_SOURCE"])
sys.path.append(str(SOURCE / "tests/integration"))  # of seeds.py
BIN = pathlib.Path(os.environ["LIGATURE_BIN"])
SCENES = SOURCE / "scenes"
OVERHAND = SCENES / "operators/overhand.csv"


def run_program(name, *args):
    return subprocess.run([BIN / name, *map(str, args)], capture_output=True, text=True, timeout=200)


@pytest.fixture
def paper():
    """A short thread of the paper's model."""
    return ligature.Scene.load(SCENES / "paper.toml", {"suture.nodes": 20})


@pytest.fixture
def overhand():
    return ligature.Script.load(OVERHAND)
