"""NOTICE.md names everything that the project installs: Python and npm packages, libraries from apt.

Run: python3 tests/architecture/notice_rules.py [ROOT]; prints one line per package that is missing or no longer
installed, and exits with 1 if any."""

import json
import pathlib
import re
import sys

NAMED_TOO = {"ruckig", "liblcm-bin"}  # ruckig: an archive that CMake unpacks; liblcm-bin: programs that are only run


def python_packages(root):
    texts = [(root / name).read_text() for name in ("requirements.txt", "requirements-test.txt")]
    return {name for text in texts for name in re.findall(r"^([A-Za-z][\w.-]*)==", text, re.M)}


def npm_packages(root):
    return {name for file in ("host/view/page/package.json", "tests/browser/package.json")
            for name in json.loads((root / file).read_text()).get("dependencies", {})}


def apt_libraries(root):
    """apt packages of libraries that are compiled or linked into programs. Compilers, browsers and emulators are left
    out."""
    words = set(re.findall(r"\b(?:lib|nlohmann)[\w-]*-dev\b", (root / "scripts/setup").read_text()))
    return words - {"libclang-rt-dev"}  # clang's own library, for fuzzing


def faults(wanted, notice):
    named = set(re.findall(r"`((?:@[\w-]+/)?[\w.-]+)`", notice))
    missing = [f"NOTICE.md: does not name {name}, which the project installs" for name in sorted(wanted - named)]
    return missing + [f"NOTICE.md: names {name}, which nothing installs" for name in sorted(named - wanted - NAMED_TOO)]


def self_check():
    """Checks that the rules reject bad examples."""
    assert faults({"numpy", "three"}, "`numpy`") == ["NOTICE.md: does not name three, which the project installs"]
    assert faults({"numpy"}, "`numpy` `scipy`") == ["NOTICE.md: names scipy, which nothing installs"]
    assert not faults({"numpy"}, "`numpy`")


def main():
    self_check()
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    wanted = python_packages(root) | npm_packages(root) | apt_libraries(root)
    found = faults(wanted, (root / "NOTICE.md").read_text())
    print("\n".join(found) if found else f"NOTICE.md names the {len(wanted)} packages that are installed")
    return 1 if found or len(wanted) < 20 else 0


if __name__ == "__main__":
    sys.exit(main())
