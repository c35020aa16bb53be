"""A simulation from Python: array views, copies, partial runs, rollouts, queries, knots."""

import copy
import ctypes
import gc
import resource
import signal
import threading
import time

import numpy as np
import pytest

import ligature
from conftest import SCENES


def circle(n, radius_m=0.5):
    turn = np.linspace(0.0, 1.5 * np.pi, n)
    return np.stack([radius_m * np.cos(turn), radius_m * np.sin(turn), 0.0 * turn], axis=1)


@pytest.mark.parametrize("name", ["paper", "suture-3-0-knot"])
def test_nodes_are_a_view_that_follows_the_thread(name):
    sim = ligature.Simulation(ligature.Scene.load(SCENES / f"{name}.toml"))
    nodes, velocities = sim.nodes, sim.velocities
    assert nodes.shape == velocities.shape == (sim.scene.nodes, 3) and nodes.dtype == np.float64
    before, address = nodes.copy(), nodes.ctypes.data
    for _ in range(20):
        sim.tick()
    assert not np.array_equal(nodes, before) and np.any(velocities)
    assert np.array_equal(nodes, sim.nodes) and sim.nodes.ctypes.data == address, "a view, not a copy"
    sim.reset()
    assert np.array_equal(nodes, before) and sim.ticks == 0 and not np.any(velocities)
    with pytest.raises(ValueError):
        nodes[0, 0] = 1.0  # views are read-only
    del sim
    gc.collect()
    assert np.array_equal(nodes, before), "the view keeps its simulation alive"


def test_a_copy_goes_its_own_way(paper, overhand):
    sim = ligature.Simulation(paper)
    sim.run(overhand, 0.5)
    for other in (sim.copy(), copy.copy(sim), copy.deepcopy(sim)):
        assert type(other) is ligature.Simulation and other.ticks == 500
        before = sim.nodes.copy()
        a = other.run(overhand, 0.1, start_s=0.5)
        assert np.array_equal(sim.nodes, before)
        assert np.array_equal(a.trace, sim.copy().run(overhand, 0.1, start_s=0.5).trace)


@pytest.mark.parametrize(("name", "overrides"), [
    *(("paper", {"suture.model": f"paper-{k}", "suture.nodes": 20}) for k in range(1, 6)),
    ("suture-3-0-knot", {}), ("suture-3-0-surgeons", {"contact.turns_thread": True}), ("desk", {})])
def test_a_saved_state_continues_to_the_bit(name, overrides, tmp_path):
    """A knot is drawn, with remeshing; saved in the midst of it, also through a file, and loaded by another simulation."""
    scene = ligature.Scene.load(SCENES / f"{name}.toml", overrides)
    sim, others = ligature.Simulation(scene), [ligature.Simulation(scene), ligature.Simulation(scene)]
    ends = [sim.nodes[0].copy(), sim.nodes[-1].copy()]

    def draw(which, ticks):
        for k in range(ticks):
            t_s = 1e-3 * (which.ticks + 1)
            tools = [ligature.Tool(end + [side * 0.1 * t_s, 0, 0], [side * 0.1, 0, 0], True) for end, side in zip(ends, (-1, 1), strict=True)]
            which.tick(*tools)

    draw(sim, 150)
    image = sim.save(tmp_path / "image")
    assert (tmp_path / "image").read_bytes() == image and list(tmp_path.iterdir()) == [tmp_path / "image"]
    for other, source in zip(others, (image, tmp_path / "image"), strict=True):
        views = other.nodes, other.velocities
        assert other.load(source) is other and other.ticks == 150
        assert np.array_equal(views[0], sim.nodes) and np.array_equal(views[1], sim.velocities), "views follow"
    for each in (sim, *others):
        draw(each, 150)
    for other in others:
        assert np.array_equal(other.nodes, sim.nodes) and np.array_equal(other.velocities, sim.velocities)
        assert np.array_equal(other.contacts.forces_N, sim.contacts.forces_N)
        assert np.array_equal(other.left.f_W_N, sim.left.f_W_N) and other.diagnostics.potential_J == sim.diagnostics.potential_J


def test_an_image_of_another_thread_is_refused(paper, tmp_path):
    sim = ligature.Simulation(paper)
    image, before = sim.save(), sim.nodes.copy()
    other = ligature.Simulation(ligature.Scene.load(SCENES / "paper.toml", {"suture.nodes": 20, "contact.friction": 0.31}))
    for bad, says in ((other.save(), "saved by a simulation of another scene"), (image[:-1], "damaged"), (image + b"x", "damaged"),
                      (b"", "found 0 bytes"), (b"x" * 100, "no image")):
        with pytest.raises(ligature.Refusal, match="^image: .*" + says):
            sim.load(bad)
    with pytest.raises(FileNotFoundError):
        sim.load(tmp_path / "none")
    assert np.array_equal(sim.nodes, before) and sim.save() == image


def test_a_run_in_pieces_is_the_run(paper, overhand):
    whole = ligature.Simulation(paper).run(overhand, 1.0)
    sim = ligature.Simulation(paper)
    pieces = [sim.run(overhand, 0.25, start_s=0.25 * k) for k in range(4)]
    assert np.array_equal(np.concatenate([p.trace for p in pieces]), whole.trace)
    assert sim.ticks == 1000 and sim.time_s == 1.0


def test_rollout_is_each_run_alone_whatever_the_threads(paper, overhand):
    sim = ligature.Simulation(paper)
    sim.run(overhand, 0.1)
    state = sim.nodes.copy()
    away = ligature.Script.of_keys(left=[[0.0, 0.3, 0.0, 5.0, 0], [1.0, 0.3, 0.0, 4.0, 1]])
    scripts = [overhand, away, ligature.Script()] * 3
    alone = [sim.copy().run(script, 0.4) for script in scripts]
    for threads in (1, 2, 5, None):
        runs = sim.rollout(scripts, threads, duration_s=0.4)
        assert all(np.array_equal(a.trace, b.trace) and np.array_equal(a.shapes, b.shapes) for a, b in zip(runs, alone, strict=True))
    assert np.array_equal(sim.nodes, state), "the simulation itself stays as it is"
    assert sim.rollout([]) == []


def test_rollout_leaves_the_cores_to_its_threads(paper, overhand):
    """The calling thread only waits. Waking up often, it would take a core from a worker each time."""
    waits, begun_s = resource.getrusage(resource.RUSAGE_SELF).ru_nvcsw, time.monotonic()
    ligature.Simulation(paper).rollout([overhand] * 4, 2, duration_s=60.0)
    waits = resource.getrusage(resource.RUSAGE_SELF).ru_nvcsw - waits
    assert waits < 40 + 100 * (time.monotonic() - begun_s)  # it looks for signals 50 times a second


def test_rollout_ends_when_a_signal_handler_raises(paper):
    def interrupt(*_):
        raise KeyboardInterrupt

    before, begun_s = signal.signal(signal.SIGALRM, interrupt), time.process_time()
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(KeyboardInterrupt):
            ligature.Simulation(paper).rollout([ligature.Script()] * 4, 2, duration_s=2000.0)  # needs some 20 s of CPU time
    finally:
        signal.signal(signal.SIGALRM, before)
    assert time.process_time() - begun_s < 3.0


def test_other_python_threads_go_on_and_may_not_touch_a_running_simulation():
    sim = ligature.Simulation(ligature.Scene.load(SCENES / "paper.toml"))
    turns, seen = 0, []
    worker = threading.Thread(target=lambda: sim.run(duration_s=20.0))
    worker.start()
    while worker.is_alive():
        turns += 1
        for touch in (lambda: sim.nodes, sim.tick, sim.reset, sim.copy, lambda: sim.run(duration_s=0.1), lambda: sim.rollout([]),
                      lambda: sim.set_state(np.zeros((50, 3)))):
            try:
                touch()
            except RuntimeError as error:
                seen.append(str(error))
                continue
            break  # the run has ended or not begun
        time.sleep(0.001)
    assert turns > 3, "the run kept Python's lock"
    assert set(seen) == {"this simulation is running in another thread"}


def test_floating_point_mode_of_the_process_changes_nothing(paper, overhand):
    """A library may leave another rounding or denormal mode, e.g. one built with -ffast-math; here: round towards zero."""
    expected = ligature.Simulation(paper).run(overhand, 1.0).trace
    times_s = [(k + 1) * 0.001 for k in range(1000)]
    libm = ctypes.CDLL("libm.so.6")
    libm.fesetround(0xC00)  # round towards zero
    try:
        sim = ligature.Simulation(paper)
        got = sim.run(overhand, 1.0).trace
        own = ligature.Simulation(paper)
        for time_s in times_s:
            own.tick(*overhand.tools(time_s))
        assert libm.fegetround() == 0xC00, "the process keeps its own mode"
    finally:
        libm.fesetround(0)
    assert np.array_equal(got, expected) and np.array_equal(own.nodes, sim.nodes)


def test_curvature_is_that_of_the_circle_through_three_nodes(paper):
    sim = ligature.Simulation(paper)
    shape = circle(paper.nodes) + sim.nodes[0] - [0.5, 0.0, 0.0]  # node 0 is fixed
    sim.set_state(shape)
    assert np.allclose(sim.curvature_per_m[1:-1], 2.0, rtol=1e-12) and sim.curvature_per_m[0] == sim.curvature_per_m[-1] == 0.0
    assert np.array_equal(sim.nodes, shape) and not np.any(sim.velocities)


def test_tension_of_a_hanging_thread_is_the_weight_below(paper):
    sim = ligature.Simulation(ligature.Scene.load(SCENES / "paper.toml", {"suture.air_drag_per_s": 100.0}))
    sim.run(duration_s=60.0)
    below = 0.05 * 9.8 * np.arange(49, 0, -1)  # weight of the nodes of 0.05 kg below each segment
    assert np.allclose(sim.tension_N[:-1], below, rtol=1e-3)
    assert sim.tension_N[-1] == sim.tension_N[-2] and np.allclose(sim.turn_rad, 0.0)


def test_hands_feel_what_they_hold(paper):
    sim = ligature.Simulation(paper)
    tip = sim.nodes[-1].copy()
    tool = ligature.Tool(tip, grip=True)
    sim.tick(right=tool)
    assert sim.right.node == paper.nodes - 1 and sim.left.node == -1
    tool.p_W_m = tip + [0.0, 0.0, -0.5]
    for _ in range(300):
        assert sim.tick(right=tool)
    assert sim.right.f_W_N[2] > 5.0, "pulled down, it pulls the hand up"
    assert sim.left.f_W_N == [0.0, 0.0, 0.0] and sim.diagnostics.max_stretch > 0.0
    tool.grip = False
    sim.tick(right=tool)
    assert sim.right.node == -1


def test_a_tool_that_is_no_number_ends_it_and_nothing_else(paper):
    sim = ligature.Simulation(paper)
    before = sim.nodes.copy()
    assert not sim.tick(ligature.Tool((float("nan"), 0.0, 0.0)))
    assert not sim.diagnostics.finite and sim.diagnostics.bad_node == -1 and np.array_equal(sim.nodes, before)
    sim.reset()
    assert sim.tick() and sim.diagnostics.finite


def test_knots_have_names(overhand):
    assert ligature.knot(circle(30)).type == "0_1"
    t = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    trefoil = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=1)
    found, mirrored = ligature.knot(trefoil, closed=True), ligature.knot(trefoil * [1, 1, -1], closed=True)
    assert (found.type, found.determinant, found.alexander, found.crossings) == ("3_1", 3, [1, -1, 1], 3)
    assert {found.handedness, mirrored.handedness} == {"left", "right"}
    sim = ligature.Simulation(ligature.Scene.load(SCENES / "suture-3-0-square.toml"))
    assert sim.knot().type == ligature.knot(sim.nodes).type == "3_1#3_1"
    assert ligature.knot(np.full((5, 3), 1e9)).determinant is None


def test_a_run_shows_its_columns(paper, overhand):
    run = ligature.Simulation(paper).run(overhand, 0.2)
    assert run["t_s"][-1] == run.t_s[-1] == 0.2 and len(run.t_s) == 200
    assert np.array_equal(run["right_fz_N"], run.right_N[:, 2]) and run.knot().type == "0_1"
    assert run.shapes.shape == (len(run.shape_t_s), 20, 3)
    with pytest.raises(ValueError):
        run.trace[0, 0] = 1.0
