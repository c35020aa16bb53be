"""Contacts of a simulation obey statics, friction and geometry."""

import numpy as np
import pytest

import ligature
from conftest import OVERHAND, SCENES

FRICTION = 0.3
ON_DESK = {"world.desk_height_m": 0.0, "world.fixed": [], "world.grippers_collide": False, "contact.friction": FRICTION}


def distance(point, a, b):
    """From a point to the segment a b."""
    along = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return np.linalg.norm(point - a - along * (b - a))


def pulled_knot(model):
    """An overhand knot that two hands pull."""
    if model == "paper":
        sim = ligature.Simulation(ligature.Scene.load(SCENES / "paper.toml", {"suture.nodes": 35, "contact.friction": FRICTION}))
        sim.run(ligature.Script.load(OVERHAND), 22.0)
        return sim
    sim = ligature.Simulation(ligature.Scene.load(SCENES / "suture-3-0-knot.toml", {"contact.friction": FRICTION}))
    left, right = sim.nodes[0].copy(), sim.nodes[-1].copy()
    out = (right - left) / np.linalg.norm(right - left)
    for k in range(3000):
        sim.tick(ligature.Tool(left - 1e-4 * k * out, grip=True), ligature.Tool(right + 1e-4 * k * out, grip=True))
        if np.linalg.norm(sim.left.f_W_N) > 0.5:
            break
    return sim


@pytest.mark.parametrize("model", ["paper", "rod"])
def test_the_strands_of_a_knot_press_within_the_friction_cone(model):
    sim = pulled_knot(model)
    assert sim.knot().type == "3_1"
    c, nodes, radius_m = sim.contacts, sim.nodes, sim.scene.radius_m
    k = len(c.pairs)
    assert k >= 3 and c.points_m.shape == c.normals.shape == c.forces_N.shape == (k, 3) and c.gaps_m.shape == (k,)
    assert np.allclose(np.linalg.norm(c.normals, axis=1), 1.0)
    normal_N = np.sum(c.forces_N * c.normals, axis=1)
    tangent_N = np.linalg.norm(c.forces_N - normal_N[:, None] * c.normals, axis=1)
    assert np.all(normal_N > 0.0), "contact never attracts"
    assert np.all(tangent_N <= 1.001 * FRICTION * normal_N + 1e-9 * normal_N.max())
    pair = c.pairs[:, 1] >= 0
    assert pair.sum() >= 3 and np.all(np.abs(np.diff(c.pairs[pair], axis=1)) >= 2), "neighbours cannot touch"
    for (i, j), point, normal in zip(c.pairs[pair], c.points_m[pair], c.normals[pair]):
        for segment in (i, j):
            assert distance(point, nodes[segment], nodes[segment + 1]) == pytest.approx(radius_m, rel=0.2)
        apart = 0.5 * (nodes[i] + nodes[i + 1] - nodes[j] - nodes[j + 1])
        assert normal @ apart > 0.0, "from the other strand towards the segment"


@pytest.mark.parametrize(("file", "weight_N"), [("desk", 50 * 0.05 * 9.8), ("suture-3-0-knot", 0.3 * 8e-5 * 9.81)])
def test_a_desk_carries_the_weight(file, weight_N):
    scene = ligature.Scene.load(SCENES / f"{file}.toml", ON_DESK | {"suture.air_drag_per_s": 20.0})
    sim = ligature.Simulation(scene)
    line = np.zeros((scene.nodes, 3))
    line[:, 0], line[:, 2] = np.linspace(0.0, scene.length_m, scene.nodes), 1.001 * scene.radius_m
    assert len(sim.contacts.pairs) == 0, "before the first tick"
    sim.set_state(line)
    sim.run(duration_s=1.0)
    c = sim.contacts
    assert np.all(c.pairs[:, 1] == -1) and np.allclose(c.normals, [0.0, 0.0, 1.0])
    assert c.forces_N[:, 2].sum() == pytest.approx(weight_N, rel=0.01)
    assert np.allclose(c.points_m[:, 2], 0.0, atol=0.01 * scene.radius_m)
    assert all(np.array_equal(a, b) for a, b in zip(sim.copy().contacts, c, strict=True)), "a copy has the same"
    sim.reset()
    assert len(sim.contacts.pairs) == 0
