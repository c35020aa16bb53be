"""Tasks of ligature.gym: rewards by topology and by a closed form."""

import gymnasium
import numpy as np
import pytest

import ligature
import ligature.gym
from conftest import OVERHAND, SCENES
from seeds import shifted

SEED = shifted(0)


def followed(env, script, steps):
    """Plays a script through the actions. Returns the rewards, the last info and whether the task was done."""
    env.reset(seed=SEED)
    rewards, terminated = [], False
    while not terminated and len(rewards) < steps:
        _, reward, terminated, truncated, info = env.step(env.unwrapped.follow(script))
        rewards.append(reward)
        assert not truncated or len(rewards) == steps
    return np.array(rewards), info, terminated


def test_an_overhand_tied_by_a_script_is_rewarded_once():
    env = gymnasium.make("ligature/TieOverhand-v0")
    rewards, info, terminated = followed(env, ligature.Script.load(OVERHAND), 1250)
    assert terminated and info == {"knot": "3_1", "success": True}
    assert rewards[-1] == 1.0 and not rewards[:-1].any()
    assert ligature.knot(env.unwrapped.simulation.nodes).type == "3_1"


def test_a_slack_thread_is_not_rewarded():
    env = gymnasium.make("ligature/TieOverhand-v0")
    env.reset(seed=SEED)
    for step in range(1250):
        _, reward, terminated, truncated, info = env.step(np.array([0, 0, 0, -1, 0, 0, 0, -1], np.float32))
        assert reward == 0.0 and not terminated and info == {"knot": "0_1", "success": False}
        assert truncated == (step == 1249)


def test_a_knot_counts_when_it_has_stayed_for_half_a_second():
    """A knot that is set and removed between steps: 24 steps are too few, 25 are enough."""
    env = ligature.gym.TieOverhand(overrides={"world.gravity_m_per_s2": [0.0, 0.0, 0.0]})
    env.reset(seed=SEED)
    straight = env.simulation.nodes.copy()
    t = np.linspace(-2.0, 2.0, len(straight))  # long ends and one trefoil: x = t^3 - 3 t, y = t^4 - 4 t^2, z = t^5 / 5 - 2 t
    knotted = np.stack([t**3 - 3.0 * t, t**4 - 4.0 * t**2, t**5 / 5.0 - 2.0 * t], axis=1)
    knotted += straight[0] - knotted[0]
    assert ligature.knot(knotted).type == "3_1"
    seen = []
    for shape in [knotted] * 24 + [straight] + [knotted] * 25:
        env._move = lambda *_, shape=shape: env.simulation.set_state(shape) is None
        _, reward, terminated, _, info = env.step(np.zeros(8))
        seen.append((reward, terminated, info["success"]))
    assert seen[:-1] == [(0.0, False, False)] * 49 and seen[-1] == (1.0, True, True)


def test_a_figure_eight_is_undone_by_the_right_pull_alone():
    for name, type_, succeeds in (("untie", "0_1", True), ("untie-wrong", "4_1", False)):
        env = gymnasium.make("ligature/Untie-v0")
        assert env.reset(seed=SEED)[1] == {"knot": "4_1", "success": False}
        rewards, info, terminated = followed(env, ligature.Script.load(SCENES / f"operators/{name}.csv"), 600)
        assert terminated == succeeds and info == {"knot": type_, "success": succeeds}
        assert rewards.sum() == float(succeeds) and (rewards[-1] == 1.0) == succeeds


def test_another_knot_can_be_wanted():
    env = ligature.gym.Untie(goal="3_1")
    assert env.reset(seed=SEED)[1]["knot"] == "4_1" and env.goal == "3_1"
    _, info, terminated = followed(env, ligature.Script.load(SCENES / "operators/untie.csv"), 600)
    assert not terminated and info == {"knot": "0_1", "success": False}


@pytest.mark.parametrize("target_N", [1.0, 4.0])
@pytest.mark.parametrize("nodes", [20, 30])
def test_a_pull_at_rest_has_the_force_and_reward_of_the_closed_form(nodes, target_N):
    """F = (D - L) / (1 / K + L / EA), L = 5 m, EA = 800 N, K = 1200 N/m; strong drag lets the waves die out."""
    env = ligature.gym.PullForce(overrides={"suture.nodes": nodes, "suture.air_drag_per_s": 30.0})
    env.reset(seed=SEED, options={"target_N": target_N})
    fixed = env.simulation.nodes[0].copy()
    for wanted_N in (-0.5, 0.7 * target_N, target_N, 1.5 * target_N, 2.5 * target_N):
        place = fixed - [0.0, 0.0, 5.0 + wanted_N * (1.0 / 1200.0 + 5.0 / 800.0)]
        script = ligature.Script.of_keys(right=[[0.0, *place, 1]])
        for _ in range(150):
            observation, reward, terminated, _, info = env.step(env.follow(script))
            assert not terminated
        assert np.allclose(observation["hands_m"][0], place, atol=1e-6)
        if wanted_N > 0.0:
            assert np.isclose(info["force_N"], wanted_N, rtol=1e-3) and np.isclose(observation["forces_N"][0, 2], wanted_N, rtol=1e-3)
            assert abs(reward - (1.0 - min(abs(wanted_N / target_N - 1.0), 1.0))) < 4e-3
        else:
            assert info["force_N"] == 0.0 and reward == 0.0, "a slack thread"
        assert observation["target_N"][0] == np.float32(target_N) and observation["held"][0] == nodes - 1
    assert env.step([0.0, 0.0, 0.0, -1.0])[4]["force_N"] == 0.0, "open jaws hold nothing"


def test_a_given_force_leaves_the_rest_of_the_episode_as_the_seed_has_it():
    env = ligature.gym.PullForce()
    drawn, _ = env.reset(seed=SEED)
    after, _ = env.reset()
    given, _ = env.reset(seed=SEED, options={"target_N": 2.5})
    assert given["target_N"] == [2.5] != drawn["target_N"]
    assert all(np.array_equal(drawn[key], given[key]) for key in drawn if key != "target_N")
    assert np.array_equal(env.reset()[0]["hands_m"], after["hands_m"]), "nor does it change the next episode"


def test_a_hand_moves_as_far_as_its_speed_and_its_box_allow():
    env = ligature.gym.TieOverhand(speed_m_per_s=3.0, step_s=0.05)
    start, _ = env.reset(seed=SEED)
    moved, *_ = env.step([0.5, 0.0, 0.0, -1.0, 7.0, 0.0, 0.0, -1.0])
    way = moved["hands_m"] - start["hands_m"]
    assert np.allclose(way, [[0.075, 0.0, 0.0], [0.15, 0.0, 0.0]], atol=1e-6) and env.simulation.ticks == 50
    for _ in range(100):
        moved, *_ = env.step([1.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0, -1.0])
    box = env.observation_space["hands_m"]
    assert moved["hands_m"][0, 0] == box.high[0, 0] and moved["hands_m"][1, 0] == box.low[1, 0]
    assert np.isclose(box.high[0, 0], 1.2 * 5.0, atol=1e-3)
