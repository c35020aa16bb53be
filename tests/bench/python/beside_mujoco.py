"""The same thread and the same knot in MuJoCo and in Ligature, both stepped from Python, in one process and one thread.

    tests/bench/python/beside_mujoco.py [NODES ..]         default: 50 100 200

The thread, its start, the pull and MuJoCo's settings are those of tests/bench/peers.py, which compares the programs.
Here each tick of 1 ms is `Simulation.tick` and `mujoco.mj_step`, one after the other in every tick, so that other load
on the machine reaches both. Times are CPU times of this thread. Exit code 1 when a claim fails. Runs itself in the
virtual environment of peers.py, which has MuJoCo; PYTHONPATH must have the package."""

import os
import pathlib
import statistics
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/bench"))
import peers  # noqa: E402


def eased(t_s):
    u = min(max(t_s - peers.SETTLE_S, 0.0) / peers.PULL_S, 1.0)
    return u * u * (3 - 2 * u)


def ours(nodes, points):
    """A simulation that has settled, with both ends held."""
    import ligature
    scene = ligature.Scene.load(ligature.SCENES / "suture-3-0-knot.toml", {"suture.nodes": nodes, "world.grippers_collide": False})
    sim = ligature.Simulation(scene)
    hands = [ligature.Tool(points[end], grip=True) for end in (0, -1)]
    for _ in range(round(1000 * peers.SETTLE_S)):
        sim.tick(*hands)
    return sim, hands


def pull(nodes):
    """Pulls and holds both threads. @returns CPU times of each tick, us, and both end shapes, m: ours, then MuJoCo's."""
    import mujoco
    points = peers.start_shape(nodes)
    way_m = peers.way_of_each_end(points)
    sim, hands = ours(nodes, points)
    model, data, at_mm = peers.laid_out(nodes)
    model.opt.timestep = 1e-3
    us = [], []
    for tick in range(round(1000 * (peers.PULL_S + peers.HOLD_S))):
        aside_m = way_m * eased(peers.SETTLE_S + 1e-3 * (tick + 1))
        for hand, point, sense in zip(hands, (points[0], points[-1]), (-1, 1)):
            hand.p_W_m = (point[0] + sense * aside_m, point[1], point[2])
        data.mocap_pos[0][0], data.mocap_pos[1][0] = at_mm[0][0] - 1e3 * aside_m, at_mm[-1][0] + 1e3 * aside_m
        begun = time.thread_time_ns()
        sim.tick(*hands)
        between = time.thread_time_ns()
        mujoco.mj_step(model, data)
        us[0].append(1e-3 * (between - begun))
        us[1].append(1e-3 * (time.thread_time_ns() - between))
    return us, (sim.nodes.copy(), 1e-3 * data.flexvert_xpos)


def knot_of(shape):
    import ligature
    try:
        return ligature.knot(shape).type
    except ligature.Refusal:
        return "diverged"


def main():
    python = peers.own_python(ROOT / "build/peers")
    if pathlib.Path(sys.prefix) != ROOT / "build/peers":
        os.execve(python, [str(python), __file__, *sys.argv[1:]], os.environ | {"OMP_NUM_THREADS": "1"})
    failed = 0
    for nodes in map(int, sys.argv[1:] or (50, 100, 200)):
        us, shapes = pull(nodes)
        medians, knots = [statistics.median(each) for each in us], [knot_of(shape) for shape in shapes]
        worst = [max(each) for each in us]
        print(f"N {nodes:3}: ligature median {medians[0]:7.1f} worst {worst[0]:7.1f} us, knot {knots[0]};  "
              f"mujoco median {medians[1]:7.1f} worst {worst[1]:7.1f} us, knot {knots[1]}", flush=True)
        for holds, claim in ((medians[0] < medians[1], f"faster: {medians[1] / medians[0]:.2f} times"), (knots[0] == "3_1", "keeps the knot")):
            print(f"{'PASS' if holds else 'FAIL'} N = {nodes}: ours {claim}", flush=True)
            failed += not holds
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
