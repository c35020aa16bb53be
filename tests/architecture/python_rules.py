"""Every pinned Python package must run on the Python of each Debian that the README names. The machine that runs the
tests may have a newer one, on which a pin that Debian 12 cannot install goes unnoticed.
usage: python_rules.py PROJECT_FOLDER, with the Python into which scripts/setup has installed the packages"""

import importlib.metadata
import pathlib
import re
import sys

from packaging.specifiers import SpecifierSet

PYTHONS = {"Debian 12": "3.11.2", "Debian 13": "3.13.5"}


def pins(root):
    """@return names in requirements.txt and requirements-test.txt"""
    for name in ("requirements.txt", "requirements-test.txt"):
        yield from re.findall(r"^([A-Za-z0-9_.-]+)==", (root / name).read_text(), re.MULTILINE)


def main(root):
    bad = []
    for pin in (found := list(pins(root))):
        allowed = importlib.metadata.metadata(pin)["Requires-Python"] or ""
        bad += [f"{pin}: needs Python {allowed}, {debian} has {python}" for debian, python in PYTHONS.items()
                if not SpecifierSet(allowed).contains(python)]
    print("\n".join(bad) or f"{len(found)} pinned packages run on {', '.join(PYTHONS)}")
    return bool(bad) or not found


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
