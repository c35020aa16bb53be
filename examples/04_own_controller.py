"""Your own controller: a hand that pulls the thread's free end with a constant force of 2 N."""

import numpy as np

import ligature

WANTED_N, GAIN_M_PER_N_S = 2.0, 0.02
scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": 30, "world.gravity_m_per_s2": [0.0, 0.0, 0.0]})
simulation = ligature.Simulation(scene)
position_m = simulation.nodes[-1].copy()
down = np.array([0.0, 0.0, -1.0])
simulation.tick(right=ligature.Tool(position_m, grip=True))  # the jaws close on the last node

for tick in range(8000):
    pull_N = -np.dot(simulation.right.f_W_N, down)  # upward force of the thread on the hand
    velocity = GAIN_M_PER_N_S * (WANTED_N - pull_N) * down
    position_m += velocity * scene.tick_s
    if not simulation.tick(right=ligature.Tool(position_m, velocity, grip=True)):
        raise SystemExit("the thread diverged")
    if tick % 1000 == 999:
        print(f"{simulation.time_s:.1f} s: pull {pull_N:.4f} N, thread stretched by {100 * simulation.diagnostics.max_stretch:.3f} %")
assert abs(pull_N - WANTED_N) < 0.01, "the hand has not reached its force"
