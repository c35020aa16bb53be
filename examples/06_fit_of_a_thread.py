"""Fits a bending stiffness to a measured sag: the thread is clamped horizontally at one end and hangs down."""

import numpy as np

import ligature

TEXT = """
[suture]
model = "rod"
nodes = 25
length_m = 0.06
radius_m = 0.00015
air_drag_per_s = 60.0
spacing = "uniform"

[world]
gravity_m_per_s2 = [0.0, 0.0, -9.81]
fixed = [{node = 0, position_m = [0.0, 0.0, 0.0], direction = [1.0, 0.0, 0.0]}]
"""


def sag_m(EI_N_m2):
    scene = ligature.Scene.parse(TEXT, {"suture.EI_N_m2": EI_N_m2})
    simulation = ligature.Simulation(scene)
    level = np.linspace([0.0, 0.0, 0.0], [scene.length_m, 0.0, 0.0], scene.nodes)
    simulation.set_state(level)
    simulation.run(duration_s=1.5)
    return -simulation.nodes[-1][2]


truth = 4e-7
measured_m = sag_m(truth)
low, high = np.log([5e-8, 5e-6])  # bisection in the logarithm; a softer thread sags more
while high - low > 1e-2:
    middle = 0.5 * (low + high)
    low, high = (middle, high) if sag_m(np.exp(middle)) > measured_m else (low, middle)
print(f"sag {1e3 * measured_m:.2f} mm: EI fitted {np.exp(low):.4g} N m2, true {truth:.4g}")
