"""Every number of the rod that was chosen stands in firmware/physics/rod/tuning.hpp, with its reason and the test that
notices it; nowhere else in that folder does one stand.

Run: python3 tests/architecture/tuning_rules.py [ROOT]; prints one line per violation and exits with 1 if any."""

import pathlib
import re
import sys

FOLDER, TABLE = "firmware/physics/rod", "firmware/physics/rod/tuning.hpp"
MOST = 31  # numbers in the table: may only fall, or rise by one where a whole rule goes for it
# Prices are measured (work.hpp), and a material's default values are those of a real thread (material.hpp).
OTHERS = {"work.hpp", "material.hpp", "tuning.hpp"}
# Halves, quarters, small whole numbers and powers of two are mathematics. Numbers as small as rounding and as large as
# "never" tune nothing.
PLAIN = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 8.0}
SMALL, LARGE = 1e-9, 1e6
# Numbers that the code needs for another reason: limits of arithmetic, safety margins of proofs, room for lists.
REASONED = {
    "pair_search.cpp": {"1.0001F": "rounding of single precision", "2048": "room"},
    "pair_search.hpp": {"0.6": "neighbours that are never listed", "0.56": "its sine", "12": "room"},
    "contact_memory.hpp": {"0.3": "default of an input"},
    "contact_set.hpp": {"768": "room"},
    "contact_newton.hpp": {"96": "room", "192": "room"},
    "contact_newton_step.cpp": {"1e-6": "bound of a quotient", "0.7": "any direction that is not parallel"},
    "dense.cpp": {"1e-4F": "loss of digits", "1e-6F": "rounding of single precision"},
    "from_scene.cpp": {"1e-5": "setting `fine`"},
    "guard.cpp": {"0.9": "safety margin of the guard", "0.81": "its square", "0.1": "what is left of it"},
    "merge_guard.cpp": {"1.001": "rounding"},
    "mixing.cpp": {"1e-6": "regularisation"},
    "motion.cpp": {"1024.0": "smallest share tried"},
    "refine.cpp": {"1e-3": "bound of a quotient"},
    "rod.cpp": {"0.999": "all but rounding", "500": "price", "1024": "room"},
    "rod_memory.hpp": {"0.3": "default of an input"},
    "rod_substep.cpp": {"0.9": "safety margin of the guard"},
    "spin_frames.cpp": {"0.7": "any direction that is not parallel"},
    "twist.cpp": {"0.7": "any direction that is not parallel"},
    "band_columns.hpp": {"640": "room", "192": "room", "256": "room", "12": "layout"},
    "state.hpp": {"16": "room"},
    "contact_couplings.hpp": {"9": "layout"},
}
REAL = re.compile(r"(?<![\w.])(?:\d+\.\d*(?:e[-+]?\d+)?|\d+e[-+]?\d+)F?(?!\w)")
WHOLE = re.compile(r"constexpr (?:int|long|std::size_t|std::int32_t) k\w+ = (\d+)")
NUMBER = re.compile(r"\b(\w+) = ([\d.e+'-]+(?: / [\d.]+)?)[,;]")


def code_of(line):
    return line.split("//")[0]


def stray(name, line):
    """The numbers of a line of code that belong into the table."""
    reasoned = REASONED.get(name, {})
    for text in REAL.findall(code_of(line)):
        size = abs(float(text.rstrip("F")))
        if size not in PLAIN and SMALL < size < LARGE and text not in reasoned:
            yield text
    for text in WHOLE.findall(code_of(line)):
        if float(text) not in PLAIN and text not in reasoned:
            yield text


def table_faults(text, tests):
    """The faults of the table itself: too many numbers, or one without unit, reason and test."""
    body = text[text.index("struct Tuning {") : text.index("};")]
    numbers = [m[1] for line in body.split("\n") for m in NUMBER.finditer(code_of(line))]
    if len(numbers) > MOST:
        yield f"{TABLE}: {len(numbers)} numbers, {MOST} at most"
    for row in re.findall(r"(?:^  ///.*\n)*(?:^  [^/\n].*\n)+", body, re.M):  # comment lines, then their numbers
        names = ", ".join(m[1] for line in row.split("\n") for m in NUMBER.finditer(code_of(line)))
        if not names:
            continue
        said = re.search(r"Test:(?:\s|///)*([\w.*]+)", row)
        if not said:
            yield f"{TABLE}: {names}: no test is named"
        elif not any(t.startswith(said[1].rstrip(".").rstrip("*")) for t in tests):
            yield f"{TABLE}: {names}: no test {said[1]}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    assert list(stray("rod.cpp", "const double x = 0.37 * y;")) == ["0.37"]
    assert list(stray("rod.cpp", "constexpr int kTries = 7;")) == ["7"]
    assert not list(stray("rod.cpp", "return 0.5 * a + 1e-12;  // 0.37"))
    found = []
    for path in sorted((root / FOLDER).rglob("*.[ch]pp")):
        if path.name in OTHERS:
            continue
        for number, line in enumerate(path.read_text().split("\n"), 1):
            found += [f"{path.relative_to(root)}:{number}: {text} belongs into tuning.hpp" for text in stray(path.name, line)]
    tests = {f"{s}.{n}" for p in (root / "tests").rglob("*.cpp") for s, n in re.findall(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)", p.read_text())}
    found += table_faults((root / TABLE).read_text(), tests)
    print("\n".join(found) if found else "the rod's numbers stand in their table")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
