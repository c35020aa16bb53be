"""A hand learns to pull a thread with a wanted force: cross-entropy search over the 12 weights of a linear policy."""

import time

import gymnasium
import numpy as np

import ligature.gym  # registers the environments

MEMBERS, EPISODES, ELITE, GENERATIONS, TESTS, STEPS = 20, 3, 5, 12, 60, 100
rng = np.random.default_rng(0)


def scores(act, seeds):
    """Mean reward per step of one episode for each seed. act: features (k x 3) to actions (k x 4)."""
    envs = gymnasium.make_vec("ligature/PullForce-v0", num_envs=len(seeds))
    seen, _ = envs.reset(seed=[int(seed) for seed in seeds])
    total = np.zeros(len(seeds))
    for _ in range(STEPS):
        features = np.stack([seen["forces_N"][:, 0, 2] / 5.0, seen["target_N"][:, 0] / 5.0, np.ones(len(seeds))], axis=1)
        seen, reward, *_ = envs.step(np.clip(act(features), -1.0, 1.0).astype(np.float32))
        total += reward
    return total / STEPS


begun_s, mean, sigma = time.process_time(), np.zeros((4, 3)), 1.0
for generation in range(GENERATIONS):
    members = mean + sigma * rng.standard_normal((MEMBERS, 4, 3))
    each, seeds = np.repeat(members, EPISODES, axis=0), np.tile(rng.integers(1000, 1 << 30, EPISODES), MEMBERS)
    found = scores(lambda x: np.einsum("kaf,kf->ka", each, x), seeds).reshape(MEMBERS, EPISODES).mean(axis=1)
    best = members[np.argsort(found)[-ELITE:]]
    mean, sigma = best.mean(axis=0), best.std(axis=0) + 0.3 * 0.8**generation
print(f"trained in {time.process_time() - begun_s:.0f} s of CPU time on {GENERATIONS * MEMBERS * EPISODES} episodes")
agents = {"random": lambda x: rng.uniform(-1.0, 1.0, (len(x), 4)), "still": lambda x: np.tile([0.0, 0.0, 0.0, 1.0], (len(x), 1)),
          "trained": lambda x: x @ mean.T}
results = {name: scores(act, range(TESTS)) for name, act in agents.items()}  # seeds that training has not seen
results["trained - random"] = results["trained"] - results["random"]
for name, score in results.items():
    print(f"{name:16}: {score.mean():.3f} +- {1.96 * score.std(ddof=1) / TESTS**0.5:.3f} (95 %) reward a step, {TESTS} episodes")
assert score.mean() > 0.2, "the agent has not learnt more than to move at random"
