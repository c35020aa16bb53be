"""Environments of ligature.gym: Gymnasium's own check, seeds, vectors, camera, refusals."""

import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import ligature
import ligature.gym
from conftest import SCENES
from seeds import shifted

SEED = shifted(0)
IDS = ["ligature/TieOverhand-v0", "ligature/Untie-v0", "ligature/PullForce-v0"]


def played(env, seed, steps=12):
    """Observations, rewards and final nodes of an episode with random actions that depend on nothing but SEED."""
    rng = np.random.default_rng(SEED)
    seen = [env.reset(seed=seed)[0]]
    rewards = []
    for _ in range(steps):
        observation, reward, *_ = env.step(rng.uniform(-1.0, 1.0, env.action_space.shape))
        seen.append(observation)
        rewards.append(reward)
    return seen, rewards, env.unwrapped.simulation.nodes.copy()


def same(a, b):
    """Whether two episodes are equal to the bit."""
    observations = all(np.array_equal(x[key], y[key]) for x, y in zip(a[0], b[0], strict=True) for key in x.keys() | y.keys())
    return observations and a[1] == b[1] and np.array_equal(a[2], b[2])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("observation", ["shape", "camera"])
@pytest.mark.parametrize("name", IDS)
def test_gymnasium_finds_nothing(name, observation):
    check_env(gymnasium.make(name, observation=observation).unwrapped)


@pytest.mark.parametrize("observation", ["shape", "camera"])
@pytest.mark.parametrize("name", IDS)
def test_a_seed_gives_one_episode_to_the_bit_and_another_seed_another(name, observation):
    env, other = (gymnasium.make(name, observation=observation) for _ in range(2))
    first = played(env, SEED)
    assert same(first, played(other, SEED)), "in another environment"
    differs = played(env, SEED + 1)
    assert not same(first, differs)
    assert not np.array_equal(first[0][0]["hands_m"], differs[0][0]["hands_m"]) and not np.array_equal(first[2], differs[2])
    assert same(first, played(env, SEED)), "after another episode"
    assert env.reset()[0]["hands_m"].tolist() != env.reset()[0]["hands_m"].tolist(), "without a seed each episode is new"


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_a_vector_is_its_environments(mode):
    """Also in other processes, and through the automatic reset after the time limit of 5 steps."""
    vector = gymnasium.make_vec(IDS[2], num_envs=3, vectorization_mode=mode, max_episode_steps=5)
    alone = [gymnasium.make(IDS[2], max_episode_steps=5) for _ in range(3)]
    try:
        seen, _ = vector.reset(seed=SEED)
        expected = [env.reset(seed=SEED + k)[0] for k, env in enumerate(alone)]
        over = [False] * 3
        for step in range(8):
            assert all(np.array_equal(seen[key][k], expected[k][key]) for key in seen for k in range(3)), step
            actions = np.random.default_rng(step).uniform(-1.0, 1.0, vector.action_space.shape).astype(np.float32)
            seen, rewards, _, cut, _ = vector.step(actions)
            for k, env in enumerate(alone):  # the step after an episode's end resets
                expected[k], reward, _, over[k], _ = (env.reset()[0], 0.0, False, False, {}) if over[k] else env.step(actions[k])
                assert rewards[k] == reward and cut[k] == over[k]
            assert all(cut) == (step == 4)
    finally:
        vector.close()


def test_a_camera_sees_by_its_equation_and_the_nearer_strand_in_front():
    target = np.array([1.0, 2.0, 3.0])
    pixels, depth_m = ligature.gym.Camera(target, 2.0, 100).project(target + np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
    assert np.allclose(pixels[0], [50.0, 50.0]) and np.isclose(depth_m[0], 6.0), "the target is in the middle, 3 reach away"
    assert np.allclose(pixels[1], [50.0 + 150.0 / 6.0, 50.0]), "right is right"
    s, c = np.sin(np.radians(35.0)), np.cos(np.radians(35.0))
    assert np.allclose(pixels[2], [50.0, 50.0 - 150.0 * c / (6.0 - s)]) and np.isclose(depth_m[2], 6.0 - s), "up is up"
    camera = ligature.gym.Camera(target, 2.0, 101)  # odd: the target is in the middle of a pixel

    def crossing(towards):  # one strand from left to right, one from bottom to top, nearer to the eye or farther
        near, up = -towards * camera.R_CW[2], -camera.R_CW[1]
        return camera.grey(target + np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], up + near, -up + near]))

    over, under = crossing(0.5), crossing(-0.5)
    level = int(np.rint(255.0 - 191.0 * 0.5))
    assert over[50, 50] > level and under[50, 50] == level and over.dtype == np.uint8
    assert np.all(over[50, 30:70] > 0), "the line has no gaps"
    assert not camera.grey(target - 20.0 * camera.R_CW[2] * np.array([[1.0], [1.1]])).any(), "behind the camera"


def test_a_picture_has_the_thread_and_the_hands():
    env = gymnasium.make(IDS[0], render_mode="rgb_array")
    env.reset(seed=SEED)
    picture = env.render()
    assert picture.shape == (256, 256, 3) and picture.dtype == np.uint8
    for colour in ((230, 80, 60), (70, 130, 240)):
        assert 9 <= np.all(picture == colour, axis=2).sum() <= 81, colour
    assert (picture.max(axis=2) > 0).sum() > 100
    bare = ligature.gym.TieOverhand()
    bare.reset(seed=SEED)
    assert bare.render() is None


def test_a_thread_that_diverges_ends_the_episode():
    env = ligature.gym.TieOverhand(overrides={"suture.stretch_N": 1e6})
    env.reset(seed=SEED)
    for _ in range(100):
        observation, reward, terminated, _, _ = env.step([1.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0])
        assert observation in env.observation_space
        if terminated:
            break
    assert terminated and reward == -1.0 and not env.simulation.diagnostics.finite
    with pytest.raises(ligature.Refusal, match="step: found no episode"):
        env.step(np.zeros(8))


@pytest.mark.parametrize("kwargs, says", [
    ({"observation": "touch"}, "observation: found 'touch', allowed 'shape' or 'camera'"),
    ({"render_mode": "human"}, "render_mode: found 'human', allowed None or 'rgb_array'"),
    ({"step_s": 0.0}, "step_s: found 0, allowed 0.001 .. 1"),
    ({"step_s": float("nan")}, "step_s: found nan, allowed 0.001 .. 1"),
    ({"step_s": "long"}, "step_s: found str, allowed a number"),
    ({"speed_m_per_s": -1}, "speed_m_per_s: found -1, allowed 1e-06 .. 100"),
    ({"size_px": 4}, "size_px: found 4, allowed 8 .. 1024"),
    ({"goal": "overhand"}, "goal: found 'overhand', allowed a knot type such as '3_1'"),
    ({"goal": "0_1"}, "goal: found '0_1', the knot that the scene begins with; allowed another one"),
])
def test_constructors_refuse(kwargs, says):
    with pytest.raises(ligature.Refusal) as caught:
        ligature.gym.TieOverhand(**kwargs)
    assert str(caught.value) == says


def test_scenes_are_refused_as_by_the_scene_reader():
    with pytest.raises(ligature.Refusal) as expected:
        ligature.Scene.load(SCENES / "paper.toml", {"suture.nodes": 1})
    with pytest.raises(ligature.Refusal) as caught:
        ligature.gym.PullForce(scene=SCENES / "paper.toml", overrides={"suture.nodes": 1})
    assert str(caught.value) == str(expected.value)


def test_steps_and_resets_refuse():
    env = ligature.gym.PullForce()
    for call, says in [
        (lambda: env.step(np.zeros(4)), "step: found no episode, allowed after reset() and until terminated"),
        (lambda: env.reset(options={"force": 1}), "options: found 'force', allowed target_N"),
        (lambda: env.reset() and env.reset(options={"target_N": 50}), "target_N: found 50, allowed 0.5 .. 5"),
        (lambda: env.step(np.zeros(4)), "step: found no episode, allowed after reset() and until terminated"),
        (lambda: env.reset(seed=SEED) and env.step(np.zeros(3)), "action: found shape (3,) or a value that is not finite, allowed 4 finite numbers"),
        (lambda: env.step([0.0, float("nan"), 0.0, 0.0]), "action: found shape (4,) or a value that is not finite, allowed 4 finite numbers"),
        (lambda: env.step("up"), "action: found an array of <U2, allowed numbers"),
        (lambda: env.step([[1], [2, 3]]), "action: found no array of numbers, allowed rows of equally many"),
    ]:
        with pytest.raises(ligature.Refusal) as caught:
            call()
        assert str(caught.value) == says
    with pytest.raises(gymnasium.error.Error):
        env.reset(seed=-1)
    assert env.simulation.ticks == 20, "a refused step moves nothing"


def test_without_gymnasium_one_line_says_so():
    code = "import sys; sys.modules['gymnasium'] = None; import ligature.gym"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stderr.splitlines()[-1] == "ImportError: ligature.gym: gymnasium is not installed; remedy: pip install .[gym]"
