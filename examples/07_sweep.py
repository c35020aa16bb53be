"""Parameter sweep on all cores: an overhand knot in a real thread is pulled tight at several frictions and speeds;
prints peak force and knot.
"""

import numpy as np

import ligature

SPEEDS_M_PER_S = (0.02, 0.05, 0.1)


def pull(ends, speed_m_per_s):
    way = 0.03 * (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    end_s = 0.05 + 0.03 / speed_m_per_s
    hands = [[[0.0, *p, 1], [0.05, *p, 1], [end_s, *(p + sign * way), 1]] for p, sign in zip(ends, (-1, 1))]
    return ligature.Script.of_keys(*hands)


print("friction " + "".join(f"{speed:>18} m/s" for speed in SPEEDS_M_PER_S))
for friction in (0.0, 0.1, 0.3):
    scene = ligature.Scene.load(ligature.SCENES / "suture-3-0-knot.toml", {"contact.friction": friction})
    simulation = ligature.Simulation(scene)
    ends = simulation.nodes[[1, -2]]
    runs = simulation.rollout([pull(ends, speed) for speed in SPEEDS_M_PER_S], duration_s=1.0)
    print(f"{friction:8} " + "".join(f"{np.linalg.norm(run.right_N, axis=1).max():10.2f} N, {run.knot().type:>8}" for run in runs))
