"""Gymnasium environments over the simulated thread: tie an overhand knot, untie a figure-eight, pull to a force.

    import gymnasium
    import ligature.gym  # registers the environments
    env = gymnasium.make("ligature/PullForce-v0")  # or ligature/TieOverhand-v0, ligature/Untie-v0
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

docs/python.md and the classes' docstrings describe observations, actions and rewards. Needs the extra `gym`: `pip install .[gym]`.
"""

try:
    import gymnasium
except ModuleNotFoundError as error:
    if error.name != "gymnasium":
        raise
    raise ImportError("ligature.gym: gymnasium is not installed; remedy: pip install .[gym]") from None

from ligature.gym.camera import Camera
from ligature.gym.env import ThreadEnv
from ligature.gym.tasks import KnotEnv, PullForce, TieOverhand, Untie

# Time limits in steps of 0.02 s: 25 s, 12 s and 2 s.
for _task, _steps in ((TieOverhand, 1250), (Untie, 600), (PullForce, 100)):
    gymnasium.register(f"ligature/{_task.__name__}-v0", f"ligature.gym:{_task.__name__}", max_episode_steps=_steps)

__all__ = ["Camera", "KnotEnv", "PullForce", "ThreadEnv", "TieOverhand", "Untie"]
