"""Programs of users as mypy --strict sees them (test_typed.py). It is only read, never run.

Lines with `type: ignore` are wrong: mypy must find the error that is named there. It reports an ignore that nothing
needs, so a name whose type is lost (Any) fails the test too.
"""

from typing import assert_type

import numpy as np

import ligature
from ligature.rig import Rig


def a_run() -> None:
    scene = ligature.Scene.load(ligature.SCENES / "paper.toml", {"suture.nodes": 35, "contact.friction": 0.2})
    script = ligature.Script.load("overhand.csv")
    sim = ligature.Simulation(scene)
    assert_type(sim.tick(ligature.Tool((0.0, 0.0, 1.0), grip=True), None), bool)
    assert_type(sim.run(script, duration_s=1.0).knot().type, str)
    assert_type(sim.rollout([script], threads=2), list[ligature.Run])
    assert_type(sim.contacts.forces_N, np.ndarray)
    assert_type(sim.left.f_W_N, list[float])
    assert_type(sim.copy().load(sim.save("image")), ligature.Simulation)
    assert_type(ligature.knot(sim.nodes).determinant, int | None)
    assert_type(ligature.__version__, str)
    scene.nodes.append(1)  # type: ignore[attr-defined]
    sim.tick("left", None)  # type: ignore[arg-type]
    sim.rollout(3)  # type: ignore[arg-type]
    sim.curvature_per_mm  # type: ignore[attr-defined]
    ligature.Tool(1.0)  # type: ignore[arg-type]


def a_refusal() -> str:
    try:
        ligature.Recording("nowhere.lcmlog")
    except ligature.Refusal as refusal:
        assert_type(refusal, ligature.Refusal)
        return refusal  # type: ignore[return-value]
    return ""


def a_recording() -> None:
    recording = ligature.Recording("knot.lcmlog")
    again = ligature.rerun(recording, {"contact.friction": 0.1})
    assert_type(again.knots, list[tuple[float, str]])
    assert_type(len(recording.shapes[-1].shape), int)
    recording.tick  # type: ignore[attr-defined]


def a_rig() -> None:
    with Rig("paper.toml") as rig:
        rig.left.move_to((0.0, 0.0, 2.3))
        assert_type(rig.left.grip(), int)
        assert_type(rig.left.force_N, float)
        rig.left.force_mN  # type: ignore[attr-defined]
