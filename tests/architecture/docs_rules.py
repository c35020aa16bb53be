"""Everything that the documentation names must exist: links, tests, files, identifiers, scene keys, options, and pages
that code names.

Run: python3 tests/architecture/docs_rules.py [ROOT]; prints one line per error and exits with 1 if any. Also: lines of
prose in docs/ and README.md have at most 120 characters (tables, code and links may be longer), the overview of
docs/measurements lists every page there, and only the design notes have commit hashes."""

import functools
import os
import pathlib
import re
import sys

WIDEST, WRAPPED = 120, re.compile(r"README\.md|docs/(?!measurements/fault-matrix|python-api)")  # fault matrices and the Python reference are printed
SOURCES = {".cpp", ".hpp", ".h", ".py", ".js", ".mjs", ".css", ".html", ".toml", ".lcm", ".cmake", ".txt", ".csv", ".json", ".md", ".in", ""}
SKIPPED = {"build", "out", ".git", "node_modules", "__pycache__"}
# Files that exist only at run time, after a build, or on another machine: pages may name them although the tree has
# none.
MADE = re.compile(
    r"^(build|BUILD|out|share|usr|var|proc|dev|sys)/|^/|[A-Z]{3}|\b(a|b|t|knot|golden)\.\w+$"
    r"|^\.\w+$|^scene-N|^haptics-|^(trace|shape|forces|ticks|events|summary|report|knot|columns|start|held|end)\.(csv|json|png|lcmlog)$|^[\w-]+\.(rec|lcmlog|mcap|h5|deb|conf|eds|dbc|service)$"
)
FILE = re.compile(r"^(?:[\w.-]+/)*[\w.*-]*\.(?:cpp|hpp|py|mjs|js|toml|csv|md|json|lcm|css|html|\*)$|^(?:\w[\w.-]*/)+[\w.*-]*$")
TEST = re.compile(r"^[A-Z]\w+\.(?:[A-Z]\w*(?:\.{2,3})?|\*)$")
MEMBER = re.compile(r"^\w+::(\w+)(?:\(\))?$")
KEY = re.compile(r"^(?:suture|contact|world|time|hands)\.([a-z]\w*)$", re.A)
OPTION = re.compile(r"(?<![\w-])(--[a-z][\w-]+)")
FOREIGN = re.compile(r"^(?:groupadd|cmake|ctest|test_\w+) ")  # commands whose options are not ours
DECLARED = re.compile(
    r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)"
    r"|(?:add_test\(NAME|ligature_rig_test\(|ligature_hil_test\(|ligature_python_test\(|ligature_browser_test\()\s*([\w.]+)"
)
HASH = re.compile(r"\b(?=[0-9a-f]*[a-f])(?=[0-9a-f]*[0-9])[0-9a-f]{7,12}\b")
PAGE_IN_CODE = re.compile(r"\bdocs/(?:\w+/)?[\w-]+\.md")


class Tree:
    """The text of every file of the project, and the names in it: tests, options, scene keys and words of the code."""

    def __init__(self, root):
        self.root = root
        self.text = {}
        for path in sorted(root.rglob("*")):
            inside = path.relative_to(root)
            if SKIPPED.intersection(inside.parts) or not path.is_file() or path.suffix not in SOURCES:
                continue
            self.text[inside.as_posix()] = path.read_text(errors="replace")
        code = [t for p, t in self.text.items() if not p.endswith((".md", "docs_rules.py"))]
        self.words = set(re.findall(r"\w+", "\n".join(code)))
        self.options = set(OPTION.findall("\n".join(code)))
        self.keys = set(re.findall(r'"([a-z]\w*)"', "\n".join(t for p, t in self.text.items() if p.startswith("protocol/scene/"))))
        self.tests = set()
        for text in code:
            for suite, name, whole in DECLARED.findall(text):
                self.tests.add(whole or f"{suite}.{name}")
        self.folders = {parent.as_posix() for p in self.text for parent in pathlib.PurePosixPath(p).parents}

    def has_file(self, name):
        """Whether the path of a file or folder of the project ends in `name`; * stands for any part of its last
        component."""
        if name.rstrip("/") in self.folders or any(f.endswith("/" + name.rstrip("/")) for f in self.folders):
            return True
        pattern = re.compile("(?:.*/)?" + re.escape(name).replace(r"\*", r"[^/]*") + "$")
        return any(pattern.match(p) for p in self.text)

    def has_test(self, name):
        if name.endswith("*") or ".." in name:
            return any(t.startswith(name.rstrip("*.") if ".." in name else name[:-1]) for t in self.tests)
        return name in self.tests

    @functools.cache
    def anchors(self, page):
        return {anchor_of(m) for m in re.findall(r"^#+\s+(.*)$", self.text[page], re.M)}


def anchor_of(heading):
    """The anchor that GitHub generates: without links and markup, in lower case, blanks as hyphens."""
    plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def link_fault(tree, page, target):
    if re.match(r"[a-z]+:", target):
        return None
    name, _, anchor = target.partition("#")
    there = pathlib.PurePosixPath(os.path.normpath(pathlib.PurePosixPath(page).parent / name) if name else page)
    if not (tree.root / there).exists():
        return f"links to {target}, no such file"
    if anchor and anchor not in tree.anchors(there.as_posix()):
        return f"links to {target}, no such heading"
    return None


def span_fault(tree, span):
    """The error in an inline code span, or None. Only spans that look like names of this project are checked."""
    for option in OPTION.findall(span) if not FOREIGN.match(span) else ():
        if option not in tree.options:
            return f"no option {option}"
    if TEST.match(span):
        return None if tree.has_test(span) else f"no test {span}"
    if member := MEMBER.match(span):
        return None if member[1] in tree.words else f"no identifier {member[1]}"
    if key := KEY.match(span):
        return None if key[1] in tree.keys else f"no key {span} in scene files"
    if " " not in span and FILE.match(span) and not MADE.search(span):
        return None if tree.has_file(span) else f"no file {span}"
    return None


def faults(tree, page, text, narrow=False):
    """The errors of one page, as lines 'page:line: what'."""
    found, fenced = [], False
    for number, line in enumerate(text.split("\n"), 1):
        fenced ^= line.startswith("```")
        said = [link_fault(tree, page, t) for t in re.findall(r"\]\(([^)\s]+)\)", line)] if not fenced else []
        said += [span_fault(tree, s) for s in re.findall(r"`([^`]+)`", line)] if not fenced else []
        prose = not fenced and not line.startswith(("|", "    ", "#", "!["))
        if narrow and prose and len(line) > WIDEST:
            said.append(f"{len(line)} characters, prose has {WIDEST} at most")
        found += [f"{page}:{number}: {s}" for s in said if s]
    return found


def misplaced(tree):
    """The errors in how pages are sorted: a page of docs/measurements that its overview does not list, and a commit hash
    in a page other than the design notes."""
    folder, notes = "docs/measurements/", "docs/design-notes.md"
    overview = tree.text.get(folder + "README.md", "")
    pages = [p for p in tree.text if p.startswith("docs/") and p.endswith(".md")]
    found = [f"{folder}README.md: lacks a row that links to {p.removeprefix(folder)}"
             for p in pages if p.startswith(folder) and not p.endswith("README.md") and f"| [{pathlib.PurePosixPath(p).stem}](" not in overview]
    return found + [f"{p}: has a commit hash, {h}; remedy: move it to {notes}" for p in pages if p != notes for h in HASH.findall(tree.text[p])]


def self_check(tree):
    """Checks that the rules reject bad examples."""
    for bad in (
        "[a](nowhere.md)", "[a](#no-such-heading)", "`BandSolver.NoSuchTest`", "`NoSuchSuite.*`", "`no_such_file.cpp`",
        "`firmware/nowhere/`", "`Rod::no_such_member`", "`suture.no_such_key`", "`ligature-lab run --no-such-option`",
        "word " * 30,
    ):
        assert faults(tree, "README.md", bad, narrow=True), bad
    good = "`BandSolver.*` `rod.hpp` `Rod::tick()` `suture.nodes` `ligature-lab --help` [a](docs/rod.md#limits)"
    assert not faults(tree, "README.md", good), faults(tree, "README.md", good)
    assert HASH.findall("at 7ddc0a8, 88420001, 2c5ea96f and effaced") == ["7ddc0a8", "2c5ea96f"]


def main():
    tree = Tree(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve())
    self_check(tree)
    found = misplaced(tree)
    for path, text in tree.text.items():
        if path == "CHANGELOG.md":
            continue  # may name what existed in past versions only
        if path.endswith(".md"):
            found += faults(tree, path, text, narrow=bool(WRAPPED.match(path)))
        elif not path.endswith("docs_rules.py"):
            found += [f"{path}: names {page}, no such page" for page in PAGE_IN_CODE.findall(text) if page not in tree.text]
    print("\n".join(found) if found else f"what {sum(p.endswith('.md') for p in tree.text)} pages name exists")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
