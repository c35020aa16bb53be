"""Pulls a square knot at each accuracy setting; prints CPU time per tick and the deviation from the finest setting."""

import time

import numpy as np

import ligature


def pulled(accuracy):
    scene = ligature.Scene.load(ligature.SCENES / "suture-3-0-square.toml", {"suture.accuracy": accuracy})
    simulation = ligature.Simulation(scene)
    ends = simulation.nodes[[4, -5]].copy()
    apart = 0.02 * (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    hands = [[[0.0, *end, 1], [0.05, *end, 1], [0.5, *(end + way), 1]] for end, way in zip(ends, (-apart, apart))]
    begun_s = time.process_time()
    run = simulation.run(ligature.Script.of_keys(*hands), duration_s=0.6)
    return run, 1e6 * (time.process_time() - begun_s) / len(run.t_s)


finest, _ = pulled("fine")
for accuracy in ("fast", "balanced", "fine"):
    run, cost_us = pulled(accuracy)
    force_N = np.linalg.norm(run.right_N, axis=1)
    off_N = np.sqrt(np.mean((force_N - np.linalg.norm(finest.right_N, axis=1)) ** 2))
    print(f"{accuracy:9}: {cost_us:6.1f} us a tick, peak {force_N.max():.3f} N, {off_N:.4f} N rms off the finest, "
          f"stretch {100 * run['max_stretch'].max():.2f} %, knot {run.knot().type}")
