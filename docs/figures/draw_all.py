"""Draws every figure of docs/ into docs/images, or checks that the files there are what would be drawn.

draw_all.py [--check | --png DIR]; --check exits with 1 and one line per file that differs."""

import argparse
import importlib
import pathlib
import re
import sys
import tempfile

from drawing import IMAGES, save

sys.dont_write_bytecode = True  # scenes/ is installed as it is; no compiled Python belongs there

FIGURES = ("period", "states", "rod_tick", "contact_solve", "knots", "figure_eight", "accuracy_cost")
NUMBER = re.compile(r"-?\d+\.\d+|\b[a-z][0-9a-f]{10}\b")  # coordinates; ids, which depend on them


def same(a, b):
    """Whether two SVG texts are equal. Coordinates may differ by 0.01 points, as between two kinds of processor."""
    if NUMBER.sub("", a) != NUMBER.sub("", b):
        return False
    pairs = zip(NUMBER.findall(a), NUMBER.findall(b))
    return all(x == y or "." not in x or abs(float(x) - float(y)) <= 0.01 for x, y in pairs)


def self_check():
    """Checks that the comparison sees differences."""
    assert same('<path id="pa0b1c2d3e4" d="M 1.5 2.25"/>', '<path id="p00b1c2d3e4" d="M 1.501 2.25"/>')
    for other in ('<path d="M 1.6"/>', '<path d="M 1.5 2.0"/>', '<path d="L 1.5"/>', '<text d="M 1.5"/>'):
        assert not same('<path d="M 1.5"/>', other), other


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only compare with docs/images")
    parser.add_argument("--png", type=pathlib.Path, metavar="DIR", help="write PNG into DIR")
    a = parser.parse_args()
    self_check()
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        out = a.png or (pathlib.Path(folder) if a.check else IMAGES)
        out.mkdir(parents=True, exist_ok=True)
        for name in FIGURES:
            path = out / f"{name}{'.png' if a.png else '.svg'}"
            save(importlib.import_module(name).draw(), path)
            if not a.check:
                print(path)
            elif not (IMAGES / path.name).exists() or not same(path.read_text(), (IMAGES / path.name).read_text()):
                wrong.append(f"docs/images/{path.name}: is not what scripts/figures draws")
    if a.check:
        others = sorted(p.name for p in IMAGES.glob("*.svg") if p.stem not in FIGURES)
        wrong += [f"docs/images/{name}: nothing draws it" for name in others]
        print("\n".join(wrong) if wrong else f"{len(FIGURES)} figures are what scripts/figures draws")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
