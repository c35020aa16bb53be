"""A figure for a paper: the thread while its knot is tied, and the forces on the hands:
  `python examples/08_plot_for_a_paper.py OUT.pdf`
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import ligature

scene = ligature.Scene.load(ligature.SCENES / "paper.toml")
script = ligature.Script.load(ligature.SCENES / "operators" / "overhand.csv")
run = ligature.Simulation(scene).run(script, duration_s=21.0, shape_every_s=0.5)

figure, (thread, force) = plt.subplots(1, 2, figsize=(7.0, 2.8), layout="constrained")
for t_s in (2.0, 8.0, 14.0, 20.0):
    shape = run.shapes[np.abs(run.shape_t_s - t_s).argmin()]
    thread.plot(shape[:, 0], shape[:, 2], label=f"{t_s:g} s")
thread.set(xlabel="x, m", ylabel="z, m", aspect="equal")
thread.legend(frameon=False)
for hand, vectors in {"left": run.left_N, "right": run.right_N}.items():
    force.plot(run.t_s, np.linalg.norm(vectors, axis=1), linewidth=0.8, label=hand)
force.set(xlabel="t, s", ylabel="force on the hand, N (world)")
force.legend(frameon=False)
figure.savefig(sys.argv[1], metadata={"Title": f"{scene.path}, {scene.nodes} nodes, ligature {ligature.__version__}"})
print(f"{sys.argv[1]}: knot {run.knot().type}, peak {np.abs(run.trace[:, 1:7]).max():.1f} N")
