"""Each script of examples/ runs unchanged, prints what it should, and is short."""

import os
import subprocess
import sys

import pytest

from conftest import SOURCE

EXAMPLES = sorted((SOURCE / "examples").glob("*.py"))
SAYS = {
    "01_first_knot": "3_1 right, determinant 3, Alexander [1, -1, 1]",
    "02_forces_of_a_recording": "left : peak ",
    "03_own_scene": "friction 0.4: 1000 ticks",
    "04_own_controller": "8.0 s: pull 2.0",
    "05_accuracy_against_cost": "0.0000 N rms off the finest",
    "06_fit_of_a_thread": "true 4e-07",
    "07_sweep": "3_1",
    "08_plot_for_a_paper": "knot 3_1",
    "09_gym": "trained - random: 0.",
    "10_film": "100 pictures",
    "11_contacts_in_a_knot": "knot 3_1",
}


def test_all_are_known():
    assert [path.stem for path in EXAMPLES] == list(SAYS)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_runs(path, tmp_path):
    arguments = {"02": [SOURCE / "tests/fixtures/golden.lcmlog"], "08": [tmp_path / "figure.pdf"], "10": [tmp_path / "film.gif"]}.get(path.stem[:2], [])
    done = subprocess.run([sys.executable, path, *arguments], capture_output=True, text=True, timeout=280, cwd=tmp_path,
                          env=os.environ | {"MPLCONFIGDIR": str(tmp_path), "MPLBACKEND": "agg"})
    assert done.returncode == 0, done.stderr
    assert SAYS[path.stem] in done.stdout, done.stdout
    assert len(path.read_text().splitlines()) <= 40
