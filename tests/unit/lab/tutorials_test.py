"""docs/tutorials.md: every command on the page runs, and prints what the page says. Of docs/scene.md: the rules of the
models.

Run: python3 tutorials_test.py LIGATURE_LAB SOURCE. Blocks marked `sh` run in order, in one folder; the block marked
`text` below one is its output. Lines that begin with `tick` are not compared, because they depend on the computer.
Numbers may differ by 10 %, or by 0.02: other compilers round differently, and knots amplify that. Words may not."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

LAB, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SHARE, LEAST = 0.1, 0.02
BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```$", re.M | re.S)


def number(word):
    try:
        return float(word.strip("%,;:"))
    except ValueError:
        return None


def alike(said, seen):
    """Whether two words are equal, or numbers that are nearly so."""
    a, b = number(said), number(seen)
    if a is None or b is None:
        return said == seen
    return abs(a - b) <= max(LEAST, SHARE * abs(a))


def same(said, seen):
    """Whether two texts agree line by line and word by word; cells of CSV lines are words."""
    lines = [[line.replace(",", " ").split() for line in text.splitlines() if not line.startswith("tick ")]
             for text in (said, seen)]
    return len(lines[0]) == len(lines[1]) and all(
        len(a) == len(b) and all(map(alike, a, b)) for a, b in zip(*lines))


def self_check():
    """Differences that must be seen, and those that must not."""
    for said, seen in (("knot 3_1", "knot 0_1"), ("a 1.0", "a 1.2"), ("a", "a\nb"), ("0.3 N", "0.3 m"), ("x", "")):
        assert not same(said, seen), (said, seen)
    assert same("force 155.2 N\ntick 3 us\n1,39,0.1", "force 150 N\ntick 9 us\n1,39,0.1000001")


def shell(text, folder):
    environment = dict(os.environ, PATH=f"{LAB.parent}:{os.environ['PATH']}")
    return subprocess.run(["bash", "-c", text], cwd=folder, env=environment, text=True, timeout=300,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def tutorials(folder):
    (folder / "scenes").symlink_to(SOURCE / "scenes")
    page = (SOURCE / "docs/tutorials.md").read_text()
    blocks = BLOCK.findall(page)
    assert page.count("```") == len(re.findall("^```", page, re.M)), "a block of docs/tutorials.md begins within a line"
    ran = 0
    for (kind, text), (next_kind, said) in zip(blocks, blocks[1:] + [("", "")]):
        if kind == "text":
            continue
        said = said if next_kind == "text" else ""
        done = shell(text, folder)
        refused = said.startswith("ligature-lab: ")
        assert done.returncode == (2 if refused else 0), f"exit code {done.returncode} of\n{text}{done.stdout}"
        assert same(said, done.stdout), f"{text}prints\n{done.stdout}but the page says\n{said}"
        ran += 1
    assert ran >= 10, f"only {ran} blocks were found"
    return ran


def fixed(count):
    return "world.fixed=[" + ", ".join(f"{{node={i}, position_m=[0, 0, 0]}}" for i in range(count)) + "]"


def rules(folder):
    """The rules of the models, as docs/scene.md quotes them."""
    rod, paper = "[suture]\nmodel = \"rod\"\n", "[suture]\n"
    page = (SOURCE / "docs/scene.md").read_text()
    for scene, settings, says in (
        (rod, ["suture.nodes=3"], "suture.nodes: found 3, the rod model needs 4 or more"),
        (rod, ["world.desk_height_m=0"],
         "suture.initial: found node 1 below world.desk_height_m, the rod model needs a start above the desk"),
        (rod, ["contact.solver=paper"], 'contact.solver: found "paper", the rod model has "none" and "implicit"'),
        (rod, ["suture.GJ_N_m2=0", "suture.yield_strain=0.1"], "suture.yield_strain: needs suture.GJ_N_m2 above 0"),
        (rod, [fixed(15)], "world.fixed: found 15 nodes, the rod model takes 14"),
        (paper, [fixed(7)], "world.fixed: found 7, allowed 6 with hooks (world.frame_collides = false lifts that)"),
    ):
        (folder / "rule.toml").write_text(scene)
        arguments = [part for setting in settings for part in ("--set", setting)]
        done = subprocess.run([LAB, "run", "rule.toml", *arguments], cwd=folder, capture_output=True, text=True, timeout=60)
        assert done.returncode == 2 and done.stderr == f"ligature-lab: rule.toml: {says}\n", done
        assert f"- `{says}`" in page, f"docs/scene.md does not quote: {says}"
    for key in ("suture.rest_curvature_per_m=1", "suture.rest_twist_per_m=1", "contact.turns_thread=true"):
        (folder / "rule.toml").write_text(rod)
        done = subprocess.run([LAB, "run", "rule.toml", "--set", "suture.GJ_N_m2=0", "--set", key], cwd=folder,
                              capture_output=True, text=True, timeout=60)
        assert "needs suture.GJ_N_m2 above 0" in done.stderr, done
    done = subprocess.run([LAB, "run", "rule.toml", "--set", "hands.pinch_width_m=0.001", "--set", fixed(9)], cwd=folder,
                          capture_output=True, text=True, timeout=60)
    assert "the rod model takes 8" in done.stderr and "above 0 it takes 8" in page, done


def main():
    self_check()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        rules(folder)
        print(f"{tutorials(folder)} blocks of docs/tutorials.md print what it says")


if __name__ == "__main__":
    main()
