"""The part that all environments share: hands, observations, random start."""

from typing import Any

import gymnasium
import numpy as np

from ligature import SCENES, _core
from ligature.gym.camera import LEFT_RGB, RIGHT_RGB, Camera
from ligature.gym.spaces import cut, hand_spaces, shape_spaces, within
from ligature.inputs import Overrides, Path, Scene, lines_of, numbers
from ligature.simulation import Simulation

RENDER_PX = 256
Seen = dict[str, np.ndarray]  # an observation


class ThreadEnv(gymnasium.Env):
    """A thread and h hands that an agent moves; the tasks are subclasses.

    Action, 4 h numbers in [-1, 1], for each hand: velocity x, y, z as a fraction of speed_m_per_s, and the jaws (closed
    if > 0). Larger values are clipped. A hand moves evenly during a step and stops at the edge of its box: the scene's
    settled thread with 1.2 of its length on every side.

    Observation, a dictionary of float32 arrays: nodes_m (n x 3), velocities_m_per_s (n x 3), hands_m (h x 3), held (h:
    number of the held node, -1: none), forces_N (h x 3: on each hand). With observation="camera", camera (size_px x
    size_px x 1, uint8) takes the place of the first two. Values beyond the space's bounds are clipped.

    reset(seed) draws the start: each node i of n moves with w i / (n - 1), w uniform in +-START_M_PER_S per axis, and
    each hand starts within +-START_M of its place. If the thread diverges, the episode ends with the reward -1.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}
    HANDS: tuple[str, ...] = ("left", "right")  # the hands that the action moves
    SCENE = "paper.toml"  # of the shipped scenes
    OVERRIDES: dict[str, Any] = {}  # of this scene
    SETTLE_S = 0.0  # time simulated before the start
    START_M_PER_S, START_M, SPEED_M_PER_S = 0.1, 0.05, 5.0
    OPTIONS: tuple[str, ...] = ()  # what reset(options) accepts

    def __init__(self, scene: Path | None = None, overrides: Overrides | None = None, observation: str = "shape",
                 step_s: float = 0.02, speed_m_per_s: float | None = None, size_px: int = 64,
                 render_mode: str | None = None) -> None:
        """scene: path; None: the task's own. overrides: as for Scene.load. step_s: rounded to whole ticks.

        Raises Refusal.
        """
        if observation not in ("shape", "camera"):
            raise _core.Refusal(f"observation: found {observation!r}, allowed 'shape' or 'camera'")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise _core.Refusal(f"render_mode: found {render_mode!r}, allowed None or 'rgb_array'")
        self.render_mode = render_mode
        if scene is None:
            scene, overrides = SCENES / self.SCENE, lines_of(self.OVERRIDES) + lines_of(overrides)
        self.simulation = Simulation(Scene.load(scene, overrides))
        tick_s = self.simulation.scene.tick_s
        self._ticks = round(within(step_s, "step_s", tick_s, 1.0) / tick_s)  # of a step
        self.step_s = self._ticks * tick_s
        speed = self.SPEED_M_PER_S if speed_m_per_s is None else speed_m_per_s
        self.speed_m_per_s = within(speed, "speed_m_per_s", 1e-6, 100.0)
        if self.SETTLE_S > 0.0:
            self.simulation.run(duration_s=self.SETTLE_S)
        self._start = self.simulation.nodes.copy()
        if not self.simulation.diagnostics.finite:
            raise _core.Refusal("scene: found a thread that diverges at rest, allowed a stable one")
        length_m = self.simulation.scene.length_m
        self._low, self._high = self._start.min(0) - 1.2 * length_m, self._start.max(0) + 1.2 * length_m
        target = 0.5 * (self._start.min(0) + self._start.max(0))
        size = int(within(size_px, "size_px", 8, 1024))
        self._camera = Camera(target, 0.6 * length_m, size) if observation == "camera" else None
        self._render_camera = Camera(target, 0.6 * length_m, RENDER_PX)
        self._playing = False
        self._hands_m = np.zeros((len(self.HANDS), 3))
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (4 * len(self.HANDS),), np.float32)
        self.observation_space = gymnasium.spaces.Dict(self._spaces(size))

    def _spaces(self, size: int) -> dict[str, gymnasium.Space]:
        """Of the observation."""
        n = len(self._start)
        sight = ({"camera": gymnasium.spaces.Box(0, 255, (size, size, 1), np.uint8)} if self._camera
                 else shape_spaces(self._low, self._high, n))
        return sight | hand_spaces(self._low, self._high, n, len(self.HANDS))

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Seen, dict[str, Any]]:
        """Starts an episode. The same seed gives the same start to the bit. options: see the task. Raises Refusal."""
        if unknown := [key for key in options or {} if key not in self.OPTIONS]:
            raise _core.Refusal(f"options: found {unknown[0]!r}, allowed {', '.join(self.OPTIONS) or 'none'}")
        super().reset(seed=seed)
        self._playing = False  # until the options are accepted
        way = np.arange(len(self._start))[:, None] / (len(self._start) - 1)
        self.simulation.reset()
        self.simulation.set_state(self._start, way * self.np_random.uniform(-self.START_M_PER_S, self.START_M_PER_S, 3))
        drawn_m = self.np_random.uniform(-self.START_M, self.START_M, (len(self.HANDS), 3))
        self._hands_m = np.clip(self._places_m() + drawn_m, self._low, self._high)
        self._begin(options or {})
        self._playing = True
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        """Moves the hands for step_s. Raises Refusal for an action of another shape or with a value not finite."""
        if not self._playing:
            raise _core.Refusal("step: found no episode, allowed after reset() and until terminated")
        wanted = numbers(action, "action")
        if wanted.shape != self.action_space.shape or not np.all(np.isfinite(wanted)):
            raise _core.Refusal(f"action: found shape {wanted.shape} or a value that is not finite, "
                                f"allowed {self.action_space.shape[0]} finite numbers")
        wanted = np.clip(wanted, -1.0, 1.0).reshape(-1, 4)
        from_m = self._hands_m
        to_m = np.clip(from_m + self.speed_m_per_s * self.step_s * wanted[:, :3], self._low, self._high)
        finite = self._move(from_m, to_m, wanted[:, 3] > 0.0)
        self._hands_m = to_m
        reward, terminated = self._judge() if finite else (-1.0, True)
        self._playing = not terminated
        return self._observation(), float(reward), terminated, False, self._info()

    def _move(self, from_m: np.ndarray, to_m: np.ndarray, grips: np.ndarray) -> bool:
        """Simulates with hands that move evenly (h x 3, m). Returns False once the state is not finite."""
        tools = {name: _core.Tool(list(from_m[k]), list((to_m[k] - from_m[k]) / self.step_s), bool(grips[k]))
                 for k, name in enumerate(self.HANDS)}
        for tick in range(1, self._ticks + 1):
            at_m = from_m + (to_m - from_m) * (tick / self._ticks)
            for k, tool in enumerate(tools.values()):
                tool.p_W_m = at_m[k].tolist()
            if not self.simulation.tick(**tools):
                return False
        return True

    def follow(self, script: _core.Script) -> np.ndarray:
        """The action that brings the hands to where the script has them a step later, as far as their speed allows."""
        tools = dict(zip(("left", "right"), script.tools(self.simulation.time_s + self.step_s)))
        way_m = np.array([tools[name].p_W_m for name in self.HANDS]) - self._hands_m
        velocity = np.clip(way_m / (self.speed_m_per_s * self.step_s), -1.0, 1.0)
        grips = [[1.0 if tools[name].grip else -1.0] for name in self.HANDS]
        return np.hstack([velocity, grips]).astype(np.float32).ravel()

    def hand(self, k: int) -> _core.Hand:
        """Hold of the k-th of HANDS."""
        return getattr(self.simulation, self.HANDS[k])

    def _observation(self) -> Seen:
        hands = [self.hand(k) for k in range(len(self.HANDS))]
        sight = ({"camera": self._camera.grey(self.simulation.nodes)[:, :, None]} if self._camera
                 else {"nodes_m": self.simulation.nodes, "velocities_m_per_s": self.simulation.velocities})
        touch = {"hands_m": self._hands_m, "held": [hand.node for hand in hands],
                 "forces_N": [hand.f_W_N for hand in hands]}
        return cut(self.observation_space, sight | touch | self._extra())

    def render(self) -> np.ndarray | None:
        """The thread in grey, left hand red, right hand blue: 256 x 256 x 3 uint8; None without render_mode."""
        if self.render_mode is None:
            return None
        colours = [{"left": LEFT_RGB, "right": RIGHT_RGB}[name] for name in self.HANDS]
        return self._render_camera.coloured(self.simulation.nodes, self._hands_m, colours)

    def _places_m(self) -> np.ndarray:
        """Where the hands start, h x 3, m."""
        raise NotImplementedError

    def _begin(self, options: dict[str, Any]) -> None:
        """Prepares the task for a new episode; the thread and the hands are at their start."""
        raise NotImplementedError

    def _judge(self) -> tuple[float, bool]:
        """Reward of the step, and whether the task is done."""
        raise NotImplementedError

    def _extra(self) -> dict[str, Any]:
        """Further observations of the task."""
        return {}

    def _info(self) -> dict[str, Any]:
        raise NotImplementedError
