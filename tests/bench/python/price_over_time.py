#!/usr/bin/env python3
"""Time of ticks that use more than 60 % of their budget: threads crumpled into balls beside pulls of two knots.

usage: PYTHONPATH=build/dev/python-package build/venv/bin/python tests/bench/python/price_over_time.py [--budget N] [--repeat N]
  --budget N    instructions of a tick (default: that of the scene)
  --repeat N    runs of each case; a tick counts with its fastest run (default 8)

A tick's budget is in instructions; its time depends on what these do. The last line has the ratio of the slowest tick of
a ball to the slowest tick of a pull with the same budget. CPU time of this thread; run nothing else meanwhile.
"""
import argparse
import itertools
import time

import numpy as np

import ligature

SEEDS, BALL_TICKS = range(3), 40
CROSSING_RADII_M = (0.003, 0.004, 0.006)  # of balls whose strands cross each other at the start
APART_RADII_M, APART_D, THROWN_M_PER_S = (0.006, 0.008), 1.2, 2.0
KNOTS, SPEEDS_M_PER_S, WAY_M, REST_S = ("square", "surgeons"), (0.15, 0.2, 0.25, 0.3), 0.1, 0.02
RADIUS_M = 0.00015  # of the thread
LEAST = 0.6  # share of the budget that a tick must use to be counted


def distances(start, end, points):
    """Distances of the segment from `start` to `end` from each segment of a polygon with n `points`, shape (n - 1,)."""
    da, db, r = end - start, np.diff(points, axis=0), points[:-1] - start
    aa, bb, ab, ar, br = da @ da, (db * db).sum(1), db @ da, r @ da, (db * r).sum(1)
    det = np.maximum(aa * bb - ab * ab, 1e-300)
    s = np.clip((ar * bb - br * ab) / det, 0.0, 1.0)
    t = np.clip((s * ab - br) / bb, 0.0, 1.0)
    s = np.clip((t * ab + ar) / aa, 0.0, 1.0)
    return np.linalg.norm(r + t[:, None] * db - s[:, None] * da, axis=1)


def ball(lengths_m, radius_m, seed, apart_m):
    """A random walk inside a sphere, with segments of `lengths_m`, shape (n,); strands stay `apart_m` apart. After each
    hundredth step that found no room the walk goes back by ten steps. @return its nodes, shape (n + 1, 3)"""
    rng, points, failed = np.random.default_rng(seed), [np.zeros(3)], 0
    while len(points) <= len(lengths_m):
        along = points[-1] - points[-2] if len(points) > 1 else np.array([1.0, 0.0, 0.0])
        along = along / np.linalg.norm(along) + 0.6 * rng.normal(size=3) - 0.6 * points[-1] / radius_m
        point = points[-1] + lengths_m[len(points) - 1] * along / np.linalg.norm(along)
        near = apart_m > 0.0 and len(points) > 2 and distances(points[-1], point, np.array(points[:-1])).min() < apart_m
        if np.linalg.norm(point) < radius_m and not near:
            points.append(point)
            continue
        failed += 1
        if failed % 100 == 0:
            del points[max(1, len(points) - 10):]
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
        print(f"{name:30} no tick uses {LEAST:.0%} of the budget", flush=True)
        return 0.0
    print(f"{name:30} {len(full):4} such ticks: median {np.median(full):5.0f} us, longest {full.max():5.0f} us", flush=True)
    return full.max()


def balls(settings, repeat):
    """Free threads in balls: at rest with strands that cross, and apart, but thrown towards the centre."""
    scene = ligature.Scene.load(ligature.SCENES / "suture-3-0.toml", {"world.fixed": "[]", **settings})
    lengths_m, longest = np.linalg.norm(np.diff(ligature.Simulation(scene).nodes, axis=0), axis=1), 0.0
    kinds = [("crossing", 0.0, 0.0, CROSSING_RADII_M), ("apart", APART_D * 2 * RADIUS_M, THROWN_M_PER_S, APART_RADII_M)]
    for kind, apart_m, speed_m_per_s, radii_m in kinds:
        for radius_m, seed in itertools.product(radii_m, SEEDS):
            points = ball(lengths_m, radius_m, seed, apart_m)

            def make():
                simulation = ligature.Simulation(scene)
                simulation.set_state(points, -speed_m_per_s / radius_m * points)
                return simulation

            longest = max(longest, told(f"ball of {1e3 * radius_m:.0f} mm, {kind}, seed {seed}",
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
