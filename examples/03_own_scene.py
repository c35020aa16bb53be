"""Your own scene: a nylon thread over a peg with loaded ends. Friction holds as much as the capstan equation says."""

import numpy as np

import ligature

TEXT = """
[suture]
model = "rod"
nodes = 60
length_m = 0.12
initial = "hanging"
radius_m = 0.00015

[world]
gravity_m_per_s2 = [0.0, 0.0, -9.81]
fixed = [{node = 0, position_m = [0.0, 0.0, 0.2]}]
loads = [{node = -1, force_N = [0.05, 0.0, 0.0]}]
pegs = [{from_m = [0.004, -0.02, 0.14], to_m = [0.004, 0.02, 0.14], radius_m = 0.003}]
"""

for friction in (0.0, 0.2, 0.4):
    scene = ligature.Scene.parse(TEXT, {"contact.friction": friction})
    simulation = ligature.Simulation(scene)
    run = simulation.run(duration_s=1.0)
    print(f"friction {friction}: {len(run.t_s)} ticks, tip at {np.round(1e3 * simulation.nodes[-1], 2)} mm, "
          f"tension {simulation.tension_N[0]:.4f} N at the top, {simulation.tension_N[-1]:.4f} N at the tip, "
          f"largest curvature 1 / {1e3 / simulation.curvature_per_m.max():.2f} mm")
