"""Where the strands of an overhand knot press on each other while two hands pull it tight, and how near they are to slipping."""

import numpy as np

import ligature

PULL_N, SPEED_M_PER_S = 0.5, 0.1
scene = ligature.Scene.load(ligature.SCENES / "suture-3-0-knot.toml", {"contact.friction": 0.3})
simulation = ligature.Simulation(scene)
left, right = simulation.nodes[0].copy(), simulation.nodes[-1].copy()
step_m = SPEED_M_PER_S * scene.tick_s * (right - left) / np.linalg.norm(right - left)
while np.linalg.norm(simulation.left.f_W_N) < PULL_N:
    if not simulation.tick(ligature.Tool(left, grip=True), ligature.Tool(right, grip=True)):
        raise SystemExit("the thread diverged")
    left, right = left - step_m, right + step_m

contacts = simulation.contacts
normal_N = np.sum(contacts.forces_N * contacts.normals, axis=1)
friction_N = np.linalg.norm(contacts.forces_N - normal_N[:, None] * contacts.normals, axis=1)
slipping = friction_N > 0.999 * scene.friction * normal_N
print(f"{simulation.time_s:.3f} s: knot {simulation.knot().type}, {len(normal_N)} contacts press with {normal_N.sum():.2f} N, "
      f"{slipping.sum()} of them slip")
for k in np.argsort(normal_N)[::-1][:5]:
    i, j = contacts.pairs[k]
    print(f"segments {i:3} and {j:3}: {1000 * normal_N[k]:6.1f} mN, friction {1000 * friction_N[k]:5.1f} mN, "
          f"overlap {-1e6 * contacts.gaps_m[k]:5.2f} um")
