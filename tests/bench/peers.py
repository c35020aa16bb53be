#!/usr/bin/env python3
"""The same thread and the same knot in MuJoCo and in Ligature, compared on one machine in one run.

usage: peers.py [--lab ligature-lab] [--host ligature-host] [--venv build/peers] [--nodes 50 100 200] [--steps 1e-3 2e-4 1e-4]
                [--runs 3]

MuJoCo 4.0.0 from PyPI is installed in a separate virtual environment (at the first run; needs the network). Its native
1D flex (a discrete elastic rod, implicit under integrator "discrete") models the thread of scenes/suture-3-0-knot.toml:
0.3 m, 0.3 mm, E 1 GPa, friction 0.3, started from the same loose overhand. Two hands draw the ends apart to 93 % of the
length in 0.25 s and hold. Times are CPU times of the thread of execution per 1 ms tick, in pull and hold. Both programs
are deterministic: each is run three times, which must end in the same shape, and each tick counts with its fastest run,
to exclude disturbances by other processes and the hypervisor. The first run's own times are printed beside.

MuJoCo's settings are chosen in its favour: the hardest contacts it allows (solimp 0.9999; with its defaults the light
loop sinks through itself), a start brought to rest at steps of 0.1 ms with strong drag until the knot is supported by
its contacts, and ten times our bending damping. It runs at 1 ms and at smaller steps, to find those that keep the knot,
and their cost. Prints a table and verdicts; exit code 1 when one fails.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = ("mujoco==4.0.0", "numpy==2.4.6")
SETTLE_S, PULL_S, HOLD_S, SHARE = 0.1, 0.25, 0.25, 0.93
# For the start in MuJoCo: damping per second, duration of each, time step.
DRAGS_PER_S, DRAG_S, DRAG_STEP_S = (5e4, 5e3, 500.0, 500.0), 0.05, 1e-4
LENGTH_M, RADIUS_M, YOUNG_PA, POISSON, KG_PER_M = 0.3, 1.5e-4, 1e9, 0.4, 8e-5


def own_python(folder):
    """The Python interpreter of the virtual environment, which is created if it does not exist."""
    python = folder / "bin/python"
    if not (folder / "ready").exists():
        print(f"making {folder} with {', '.join(PACKAGES)}", flush=True)
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "-q", *PACKAGES], check=True)
        (folder / "ready").touch()
    return python


def start_shape(nodes):
    """The scene's loose overhand as `nodes` equally spaced points, m."""
    lines = (ROOT / "scenes/shapes/overhand-loose.csv").read_text().splitlines()
    points = [tuple(map(float, line.split(","))) for line in lines if line and line[0] in "-0123456789"]
    return [tuple((1 - f) * a + f * b for a, b in zip(points[k], points[min(k + 1, len(points) - 1)]))
            for k, f in ((int(at), at - int(at)) for at in ((len(points) - 1) * i / (nodes - 1) for i in range(nodes)))]


def way_of_each_end(points):
    distance = sum((a - b) ** 2 for a, b in zip(points[0], points[-1])) ** 0.5
    return 0.5 * (SHARE * LENGTH_M - distance)


def least_of(who, runs):
    """For each tick the shortest time of all runs. A run is (times per tick, end shape); all end shapes must be
    equal."""
    # Compared as text, because a NaN is not equal to itself.
    if any(repr(shape) != repr(runs[0][1]) for _, shape in runs):
        raise SystemExit(f"{who}: two runs of the same pull end differently; their ticks cannot be compared")
    return [min(ticks) for ticks in zip(*(times for times, _ in runs))]


def ours(lab, nodes, folder):
    """One `ligature-lab run`: times per tick, us, the end shape and the knot."""
    points = start_shape(nodes)
    way = way_of_each_end(points)
    script = pathlib.Path(folder) / "pull.csv"
    with open(script, "w") as out:
        out.write("time,hand,x,y,z,grip\n")
        for hand, (x, y, z), sense in (("L", points[0], -1), ("R", points[-1], 1)):
            for t, moved in ((0.0, 0.0), (SETTLE_S, 0.0), (SETTLE_S + PULL_S, way)):
                out.write(f"{t},{hand},{x + sense * moved},{y},{z},1\n")
    done = subprocess.run([lab, "run", ROOT / "scenes/suture-3-0-knot.toml", "--grippers", script, "--set", f"suture.nodes={nodes}",
                           "--set", "world.grippers_collide=false", "--duration", str(SETTLE_S + PULL_S + HOLD_S), "--out", folder],
                          capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr.strip())
    with open(pathlib.Path(folder) / "trace.csv") as file:
        times = [float(row["step_us"]) for row in csv.DictReader(file)]
    shape = (pathlib.Path(folder) / "shape.csv").read_text().splitlines()[-nodes:]
    return times[round(1000 * SETTLE_S):], shape, json.loads((pathlib.Path(folder) / "summary.json").read_text())["knot"]["type"]


def flex_xml(nodes):
    """MuJoCo's model, in millimetres, grams and seconds: the thread straight along x (its rest shape), a hand at each
    end."""
    step = 1e3 * LENGTH_M / (nodes - 1)
    points = " ".join(f"{i * step:.9f} 0 0" for i in range(nodes))
    elements = " ".join(f"{i} {i + 1}" for i in range(nodes - 1))
    young = YOUNG_PA  # 1 Pa = 1 g / (mm s^2)
    grips = "".join(f'<body name="grip{k}" mocap="true" pos="{x} 0 0"/>' for k, x in enumerate((0, 1e3 * LENGTH_M)))
    ends = (0, nodes - 1)
    connects = "".join(f'<connect body1="grip{k}" body2="thread_{end}" anchor="0 0 0" solref="0.002 1"/>' for k, end in enumerate(ends))
    return f"""<mujoco><option timestep="0.001" integrator="discrete" solver="Newton" gravity="0 0 -9810" cone="elliptic"/>
<size memory="256M"/><worldbody>{grips}
<flexcomp name="thread" type="direct" dim="1" mass="{1e3 * KG_PER_M * LENGTH_M}" radius="{1e3 * RADIUS_M}" point="{points}" element="{elements}">
<contact selfcollide="auto" friction="0.3" condim="3" solref="0.0001 1" solimp="0.9999 0.9999 0.001" margin="0.05"/><edge equality="true" solref="0.002 1" solimp="0.999 0.9999 0.001"/>
<elasticity young="{young}" poisson="{POISSON}" damping="0.02"/></flexcomp></worldbody>
<equality>{connects}</equality></mujoco>"""


def laid_out(nodes):
    """MuJoCo model and data with the thread in the start shape, and that shape in mm. Runs in the virtual environment.
    """
    import mujoco
    import numpy
    model = mujoco.MjModel.from_xml_string(flex_xml(nodes))
    data = mujoco.MjData(model)
    points = 1e3 * numpy.array(start_shape(nodes))
    mujoco.mj_forward(model, data)
    moved = points - data.flexvert_xpos
    for i in range(nodes):  # every vertex is a body with three slide joints
        body = model.flex_vertbodyid[i]
        first = model.jnt_qposadr[model.body_jntadr[body]]
        data.qpos[first:first + 3] = moved[i]
    data.mocap_pos[0], data.mocap_pos[1] = points[0], points[-1]
    node_g = 1e3 * KG_PER_M * LENGTH_M / nodes
    model.opt.timestep = DRAG_STEP_S
    for drag in DRAGS_PER_S:
        model.dof_damping[:] = node_g * drag
        for _ in range(round(DRAG_S / DRAG_STEP_S)):
            mujoco.mj_step(model, data)
    model.dof_damping[:] = node_g * 5.0  # air drag as in Ligature's scene, 5 per second
    return model, data, points


def theirs(nodes, step_s):
    """Runs in the virtual environment. Prints as JSON: times per 1 ms, us, and the first and last shapes, m."""
    import mujoco
    model, data, points = laid_out(nodes)
    begin = (1e-3 * data.flexvert_xpos).tolist()
    way = 1e3 * way_of_each_end([tuple(p) for p in points / 1e3])
    model.opt.timestep = step_s
    steps, times, deepest = round(1e-3 / step_s), [], 0.0
    for tick in range(round(1000 * (PULL_S + HOLD_S))):
        spent = 0
        for k in range(steps):
            u = min(1e-3 * (tick + (k + 1) / steps) / PULL_S, 1.0)
            aside = way * u * u * (3 - 2 * u)  # the same motion as that of the hands in Ligature's run
            data.mocap_pos[0][0], data.mocap_pos[1][0] = points[0][0] - aside, points[-1][0] + aside
            before = time.thread_time_ns()
            mujoco.mj_step(model, data)
            spent += time.thread_time_ns() - before
            if data.ncon:
                deepest = max(deepest, -float(data.contact.dist.min()) / (2e3 * RADIUS_M))
        times.append(1e-3 * spent)
    print(json.dumps({"us": times, "begin": begin, "shape": (1e-3 * data.flexvert_xpos).tolist(), "deepest": deepest}))


def knot_of(host, shape, folder):
    if not all(abs(x) < 1e3 for p in shape for x in p):
        return "diverged"
    file = pathlib.Path(folder) / "shape.csv"
    file.write_text("x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in shape))
    done = subprocess.run([host, "knot", file], capture_output=True, text=True)
    words = done.stdout.split()
    return next((w for w in words if "_" in w), "unknown") if done.returncode == 0 else "unknown: " + done.stderr.strip()


def figures(times):
    times = sorted(times)
    median, worst = times[len(times) // 2], times[-1]
    return {"median": median, "p99": times[int(0.99 * len(times))], "worst": worst, "ratio": worst / median}


def report(who, nodes, first, least, knot):
    f, once = figures(least), figures(first)
    print(f"{who:15} N {nodes:3}  median {f['median']:7.1f} p99 {f['p99']:7.1f} worst {f['worst']:7.1f} us  worst/median {f['ratio']:4.2f}  "
          f"(first run {once['median']:.1f} {once['p99']:.1f} {once['worst']:.1f}, {once['ratio']:.2f})  knot {knot}", flush=True)
    return {**f, "knot": knot}


def our_runs(a, nodes):
    runs = []
    for _ in range(a.runs):
        with tempfile.TemporaryDirectory() as folder:
            *run, knot = ours(a.lab, nodes, folder)
            runs.append(run)
    return report("ligature 1 ms", nodes, runs[0][0], least_of("ligature", runs), knot)


def their_runs(a, python, nodes, step_s):
    runs = []
    for _ in range(a.runs):
        run = subprocess.run([python, __file__, "--theirs", str(nodes), "--steps", str(step_s)], capture_output=True, text=True,
                             env={**os.environ, "OMP_NUM_THREADS": "1"})
        if run.returncode:
            raise SystemExit(run.stderr.strip())
        result = json.loads(run.stdout.splitlines()[-1])
        runs.append((result["us"], result["shape"]))
    with tempfile.TemporaryDirectory() as folder:
        begun, ended = (knot_of(a.host, result[key], folder) for key in ("begin", "shape"))
    return report(f"mujoco {1e3 * step_s:g} ms", nodes, runs[0][0], least_of("mujoco", runs),
                  f"{ended} (before the pull {begun}; overlap up to {result['deepest']:.2f} diameters)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lab", default=ROOT / "build/dev/bin/ligature-lab")
    parser.add_argument("--host", default=ROOT / "build/dev/bin/ligature-host")
    parser.add_argument("--venv", type=pathlib.Path, default=ROOT / "build/peers")
    parser.add_argument("--nodes", type=int, nargs="+", default=[50, 100, 200])
    parser.add_argument("--steps", type=float, nargs="+", default=[1e-3, 2e-4, 1e-4], help="of the peer, s; the first is judged")
    parser.add_argument("--runs", type=int, default=3, help="of each; every tick counts by its fastest")
    parser.add_argument("--theirs", type=int, help=argparse.SUPPRESS)
    a = parser.parse_args()
    if a.theirs:
        return theirs(a.theirs, a.steps[0])
    python, failed = own_python(a.venv), 0
    for nodes in a.nodes:
        our = our_runs(a, nodes)
        their = [their_runs(a, python, nodes, step_s) for step_s in a.steps][0]
        for holds, claim in ((our["median"] < their["median"], "faster, median"), (our["worst"] < their["worst"], "lower worst tick"),
                             (our["ratio"] < their["ratio"], "lower worst over median"), (our["knot"] == "3_1", "keeps the knot")):
            print(f"{'PASS' if holds else 'FAIL'} N = {nodes}: ours {claim}")
            failed += not holds
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
