#!/usr/bin/env python3
"""Instructions per tick, counted by callgrind, hence independent of the machine's load.

usage: instructions.py PATH/TO/physics-step-cost

Prints one line per scenario and exits with 1 when a limit is exceeded. Limits: paper-4 at N = 50 takes at most 10,000
instructions without contact and 25,000 in a loosely tied trefoil; paper-1 at most half of paper-4; the cost grows no
faster than N log N. A scene without contact must call no function of the contact solver or its broad phases, and one
with contact must."""
import math
import re
import subprocess
import sys
import tempfile

TICKS = 300
CONTACT = re.compile(r"ContactSolver|find_pairs|SphereTree|Sweep|SegmentSpheres")


def count(program, scenario, nodes, *keys):
    with tempfile.NamedTemporaryFile() as out:
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out.name}", "--toggle-collect=*measured_tick*",
             program, "one", scenario, str(nodes), str(TICKS), *keys], capture_output=True, text=True, check=True)
        entered = {line for line in open(out.name) if line.startswith(("fn=", "cfn=")) and CONTACT.search(line)}
    total = int(re.search(r"Collected : (\d+)", run.stderr).group(1))
    print(f"{scenario:10} N {nodes:4}  {' '.join(keys):60} {total / TICKS:12,.0f}   {run.stdout.strip()}", flush=True)
    if (not entered) != ("contact.solver=none" in keys):
        raise SystemExit(f"contact code entered: {sorted(entered)}, with {' '.join(keys) or 'contact on'}")
    return total / TICKS


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    program, missed = sys.argv[1], []

    def bar(value, limit, what):
        if value > limit:
            missed.append(f"{what}: {value:,.0f}, allowed {limit:,.0f}")

    none = "contact.solver=none"
    for swivel in ("paper", "internal"):
        four = count(program, "tied", 50, none, f"suture.swivel={swivel}")
        bar(four, 10_000, f"paper-4 without contact, swivel {swivel}")
    bar(count(program, "tied", 50, none, "suture.model=paper-1"), four / 2, "paper-1 against half of paper-4")
    for model in ("paper-2", "paper-3", "paper-5"):
        count(program, "tied", 50, none, f"suture.model={model}")
    bar(count(program, "tied", 50), 25_000, "paper-4 in a loosely tied trefoil")
    count(program, "tightened", 50)  # seven contacts that all carry load: no limit, only printed
    small = count(program, "coil", 100)
    for nodes in (200, 500, 1000):
        grown = count(program, "coil", nodes)
        bar(grown, 1.15 * small * nodes * math.log(nodes) / (100 * math.log(100)), f"growth to N = {nodes}")
    for search in ("brute", "bvh", "sweep"):
        for nodes in (50, 100, 200, 500):
            count(program, "coil", nodes, f"contact.broad_phase={search}")
    for line in missed:
        print("missed:", line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
