"""The tasks: tie a knot, untie a knot, pull to a force."""

import re
from typing import Any

import gymnasium
import numpy as np

from ligature import _core
from ligature.gym.env import ThreadEnv
from ligature.gym.spaces import box, within

HELD_S = 0.5  # time for which a knot must stay
LEAST_N, MOST_N = 0.5, 5.0  # of a wanted force


class KnotEnv(ThreadEnv):
    """Reaches a knot type. The reward is 1 in the step in which ligature.knot has found the wanted type in all steps of
    the last 0.5 s; this step ends the episode. Otherwise the reward is 0. Only the type of the knot counts.

    info: knot (type of the present shape), success.
    """

    GOAL = "3_1"

    def __init__(self, goal: str | None = None, **kwargs: Any) -> None:
        """goal: a type as ligature.knot names it, such as "3_1#3_1". Further arguments: ThreadEnv. Raises Refusal."""
        self.goal = self.GOAL if goal is None else goal
        if not isinstance(self.goal, str) or not re.fullmatch(r"\d+_\d+(#\d+_\d+)*", self.goal):
            raise _core.Refusal(f"goal: found {self.goal!r}, allowed a knot type such as '3_1'")
        super().__init__(**kwargs)
        if self.simulation.knot().type == self.goal:
            raise _core.Refusal(f"goal: found {self.goal!r}, the knot that the scene begins with; allowed another one")
        self._steps_held, self._knot = 0, ""

    def _begin(self, options: dict[str, Any]) -> None:
        self._steps_held, self._knot = 0, self.simulation.knot().type

    def _judge(self) -> tuple[float, bool]:
        self._knot = self.simulation.knot().type
        self._steps_held = self._steps_held + 1 if self._knot == self.goal else 0
        done = self._success()
        return (1.0 if done else 0.0), done

    def _success(self) -> bool:
        return self._steps_held * self.step_s >= HELD_S - 1e-9

    def _info(self) -> dict[str, Any]:
        return {"knot": self._knot, "success": self._success()}


class TieOverhand(KnotEnv):
    """Ties an overhand knot (3_1, of either handedness) in the paper's thread of 35 nodes, which hangs from node 0.

    The left hand starts near the node at 0.64 of the length, the right hand near the free end, both open.
    """

    OVERRIDES = {"suture.nodes": 35}

    def _places_m(self) -> np.ndarray:
        return self._start[[round(0.64 * (len(self._start) - 1)), -1]]


class Untie(KnotEnv):
    """Undoes (0_1) the loose figure-eight knot of desk.toml with the right hand, which starts open above the thread."""

    GOAL, SCENE, HANDS, SETTLE_S = "0_1", "desk.toml", ("right",), 5.0

    def _places_m(self) -> np.ndarray:
        return self._start.mean(axis=0)[None] + [0.0, 0.0, 0.3]


class PullForce(ThreadEnv):
    """Pulls the free end with a wanted force F*. The thread hangs from node 0 without weight, and the right hand has
    taken its last node.

    F is the part of the force on the hand that acts towards node 0, and 0 if that is negative. The reward of a step is
    1 - min(|F - F*| / F*, 1): 1 at F* and 0 for a slack thread. The episode has no other end than its time limit. At
    rest, with the hand at the distance D from node 0,
        F = max(0, D - L) / (1 / K + L / EA)
    (thread: length L, stiffness EA; hand: coupling K). reset(options={"target_N": F}) sets F*; otherwise it is drawn
    from 0.5 .. 5 N. info: force_N, target_N.
    """

    HANDS, OPTIONS, START_M, SPEED_M_PER_S = ("right",), ("target_N",), 0.01, 0.2
    OVERRIDES = {"suture.nodes": 20, "world.gravity_m_per_s2": [0.0, 0.0, 0.0]}
    _target_N = LEAST_N

    def _spaces(self, size: int) -> dict[str, gymnasium.Space]:
        return super()._spaces(size) | {"target_N": box(LEAST_N, MOST_N, 1)}

    def _places_m(self) -> np.ndarray:
        return self._start[[-1]]

    def _begin(self, options: dict[str, Any]) -> None:
        drawn = self.np_random.uniform(LEAST_N, MOST_N)  # also when it is given, so that the next episode is the same
        self._target_N = within(options.get("target_N", drawn), "target_N", LEAST_N, MOST_N)
        self._move(self._hands_m, self._hands_m, np.array([True]))

    def _force_N(self) -> float:
        way_m = self.simulation.nodes[0] - self._hands_m[0]
        return max(0.0, float(np.dot(self.hand(0).f_W_N, way_m / max(np.linalg.norm(way_m), 1e-12))))

    def _judge(self) -> tuple[float, bool]:
        return 1.0 - min(abs(self._force_N() - self._target_N) / self._target_N, 1.0), False

    def _extra(self) -> dict[str, Any]:
        return {"target_N": [self._target_N]}

    def _info(self) -> dict[str, Any]:
        return {"force_N": self._force_N(), "target_N": self._target_N}
