#!/usr/bin/env python3
"""Time of ticks that use more than 60 % of their budget: threads crumpled into balls beside pulls of two knots.

usage: PYTHONPATH=build/dev/python-package build/venv/bin/python tests/bench/python/price_over_time.py [--budget N] [--repeat N]
  --budget N    instructions of a tick (default: that of the scene)
  --repeat N    runs of each case; a tick counts with its fastest run (default 8)

A tick's budget is in instructions; its time depends on what these do. The last line has the ratio of the slowest tick of
a ball to the slowest tick of a pull with the same budget. CPU time of this thread; run nothing else meanwhile.
"""
import argparse
import time

import numpy as np

import ligature

RADII_M, SEEDS, BALL_TICKS = (0.003, 0.004, 0.006), range(3), 40
KNOTS, SPEEDS_M_PER_S, WAY_M, REST_S = ("square", "surgeons"), (0.15, 0.2, 0.25, 0.3), 0.1, 0.02
LEAST = 0.6  # share of the budget that a tick must use to be counted


def ball(nodes, radius_m, seed):
    """A random walk of `nodes` nodes inside a sphere, as an array of shape (nodes, 3); its length is 0.3 m."""
    rng, step_m = np.random.default_rng(seed), 0.3 / (nodes - 1)
    points, direction = [np.zeros(3)], np.array([1.0, 0.0, 0.0])
    while len(points) < nodes:
        turned = direction + 0.9 * rng.normal(size=3)
        turned /= np.linalg.norm(turned)
        point = points[-1] + step_m * turned
        if np.linalg.norm(point) < radius_m or rng.random() < 0.02:
            points.append(point)
            direction = turned
        else:
            direction = -points[-1] / max(np.linalg.norm(points[-1]), 1e-9)
    return np.array(points)


def apart(points, speed_m_per_s):
    """The tools of each tick of a pull: both hands hold an end, rest, and draw it WAY_M outwards."""
    outwards = (points[0] - points[-1]) / np.linalg.norm(points[0] - points[-1])
    times_s = np.arange(1e-3, REST_S + WAY_M / speed_m_per_s, 1e-3)
    ways = [max(0.0, t_s - REST_S) * speed_m_per_s * outwards for t_s in times_s]
    return [[ligature.Tool(points[0] + way, grip=True), ligature.Tool(points[-1] - way, grip=True)] for way in ways]


def measured(make, tools, repeat):
    """Runs the simulation that `make` returns, one tick for each entry of `tools`, `repeat` times.
    @return time of each tick, us, the fastest of all runs, and its work as a share of the budget"""
    times, work = np.full(len(tools), np.inf), np.zeros(len(tools))
    for _ in range(repeat):
        simulation = make()
        for k, hands in enumerate(tools):
            before_ns = time.thread_time_ns()
            simulation.tick(*hands)
            times[k] = min(times[k], (time.thread_time_ns() - before_ns) / 1e3)
            work[k] = simulation.diagnostics.work / simulation.budget
    return times, work


def told(name, times, work):
    """Prints the times of the ticks that use their budget. @return the longest"""
    full = times[work > LEAST]
    if not len(full):
        print(f"{name:26} no tick uses {LEAST:.0%} of the budget", flush=True)
        return 0.0
    print(f"{name:26} {len(full):4} such ticks: median {np.median(full):5.0f} us, longest {full.max():5.0f} us", flush=True)
    return full.max()


def balls(settings, repeat):
    scene, longest = ligature.Scene.load(ligature.SCENES / "suture-3-0.toml", settings), 0.0
    for radius_m in RADII_M:
        for seed in SEEDS:
            points = ball(len(ligature.Simulation(scene).nodes), radius_m, seed)

            def make():
                simulation = ligature.Simulation(scene)
                simulation.set_state(points)
                return simulation

            longest = max(longest, told(f"ball of {1e3 * radius_m:.0f} mm, seed {seed}",
                                        *measured(make, BALL_TICKS * [[]], repeat)))
    return longest


def pulls(settings, repeat):
    longest = 0.0
    for knot in KNOTS:
        scene = ligature.Scene.load(ligature.SCENES / f"suture-3-0-{knot}.toml", settings)
        for speed_m_per_s in SPEEDS_M_PER_S:
            tools = apart(ligature.Simulation(scene).nodes, speed_m_per_s)
            longest = max(longest, told(f"{knot}, {speed_m_per_s} m/s", *measured(lambda: ligature.Simulation(scene), tools, repeat)))
    return longest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--budget", type=int)
    parser.add_argument("--repeat", type=int, default=8)
    options = parser.parse_args()
    settings = {} if options.budget is None else {"suture.work_instructions": options.budget}
    ball_us, pull_us = balls(settings, options.repeat), pulls(settings, options.repeat)
    print(f"longest tick of a ball {ball_us:.0f} us, of a pull {pull_us:.0f} us: ratio {ball_us / pull_us:.2f}")


if __name__ == "__main__":
    main()
