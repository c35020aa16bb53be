"""Ties an overhand knot with a script and prints when the knot appeared: `python examples/01_first_knot.py`."""

import ligature

scene = ligature.Scene.load(ligature.SCENES / "paper.toml")
script = ligature.Script.load(ligature.SCENES / "operators" / "overhand.csv")
run = ligature.Simulation(scene).run(script, duration_s=22.0, shape_every_s=0.1)

seen = ""
for t_s, shape in zip(run.shape_t_s, run.shapes):
    knot = ligature.knot(shape)
    if knot.type != seen:
        print(f"{t_s:5.1f} s: {knot.type} {knot.handedness}, determinant {knot.determinant}, Alexander {knot.alexander}")
        seen = knot.type
