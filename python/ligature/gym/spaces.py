"""Spaces of observations with finite bounds, and checks of arguments."""

from typing import Any

import gymnasium
import numpy as np

from ligature import _core
from ligature.inputs import number

FASTEST_M_PER_S, STRONGEST_N = 100.0, 1000.0  # larger values are cut off in observations


def within(value: Any, name: str, low: float, high: float) -> float:
    """`value` as a double. Raises Refusal when it lies outside low .. high or is not a number."""
    found = number(value, name)
    if not low <= found <= high:
        raise _core.Refusal(f"{name}: found {found:g}, allowed {low:g} .. {high:g}")
    return found


def box(low: Any, high: Any, *shape: int) -> gymnasium.spaces.Box:
    """Arrays of float32; the bounds are numbers or arrays that fit the shape."""
    limits = (np.broadcast_to(np.asarray(limit, np.float32), shape) for limit in (low, high))
    return gymnasium.spaces.Box(*limits, dtype=np.float32)


def shape_spaces(low_m: np.ndarray, high_m: np.ndarray, nodes: int) -> dict[str, gymnasium.Space]:
    """The thread's shape, within a box of the world."""
    return {"nodes_m": box(low_m, high_m, nodes, 3),
            "velocities_m_per_s": box(-FASTEST_M_PER_S, FASTEST_M_PER_S, nodes, 3)}


def hand_spaces(low_m: np.ndarray, high_m: np.ndarray, nodes: int, hands: int) -> dict[str, gymnasium.Space]:
    """What the hands know without sight."""
    return {"hands_m": box(low_m, high_m, hands, 3), "held": box(-1.0, nodes - 1.0, hands),
            "forces_N": box(-STRONGEST_N, STRONGEST_N, hands, 3)}


def cut(spaces: gymnasium.spaces.Dict, seen: dict[str, Any]) -> dict[str, np.ndarray]:
    """New arrays of the spaces' types within their bounds."""
    return {name: np.clip(np.array(seen[name], space.dtype), space.low, space.high) for name, space in spaces.items()}
