"""The task `pull`: two hands, or one, pull the ends of a thread to a force and hold it; does its knot lock?"""

import random
import time
from typing import Any

import numpy as np

from ligature import Simulation, Tool
from ligature.study.job import Job

LONGEST_S = 60.0  # of the motion


class _Hands:
    """Both ends held; `outwards` moves the hands that pull."""

    def __init__(self, simulation: Simulation, hands: int) -> None:
        self.simulation = simulation
        first, last = simulation.nodes[0].copy(), simulation.nodes[-1].copy()
        self.along = (last - first) / np.linalg.norm(last - first)
        self.tick_s = simulation.scene.tick_s
        self.tools = [Tool(first, grip=True), Tool(last, grip=True)]
        self.places = [first, last]
        self.signs = (-1.0 if hands == 2 else 0.0, 1.0)
        self.ticks, self.time_lost, self.cpu_s = 0, 0.0, 0.0

    def outwards(self, speed_m_per_s: float) -> bool:
        """One tick; False once the state is not finite."""
        for tool, place, sign in zip(self.tools, self.places, self.signs):
            velocity = sign * speed_m_per_s * self.along
            place += self.tick_s * velocity
            tool.p_W_m, tool.v_W_m_per_s = place, velocity
        begun_s = time.thread_time()
        finite = self.simulation.tick(*self.tools)
        self.cpu_s += time.thread_time() - begun_s
        self.ticks += 1
        self.time_lost += self.simulation.diagnostics.time_lost
        return finite

    def force_N(self) -> float:
        """Mean pull of the thread on the two hands."""
        left, right = (np.dot(hand.f_W_N, self.along) for hand in (self.simulation.left, self.simulation.right))
        return 0.5 * float(left - right)


def _proceed(hands: _Hands, speed_m_per_s: float, seconds: float, until_N: float = float("inf")) -> float:
    """Moves until the force is reached or the time is over. @returns the largest force, N."""
    peak_N = 0.0
    for _ in range(round(seconds / hands.tick_s)):
        if not hands.outwards(speed_m_per_s):
            raise RuntimeError(f"the thread diverged at tick {hands.simulation.diagnostics.bad_tick}")
        peak_N = max(peak_N, hands.force_N())
        if peak_N >= until_N:
            break
    return peak_N


def pull(job: Job) -> dict[str, Any]:
    """Rests for settle_s, pulls at speed_m_per_s of each hand to force_N, holds for hold_s.

    The seed draws the speed from the given one -+ speed_spread. Locked: the knot is that of the start, and at least
    least_share of force_N is left.
    """
    asked = job.arguments
    speed = asked["speed_m_per_s"] * (1 + asked["speed_spread"] * (2 * random.Random(job.seed).random() - 1))
    simulation = job.simulation(job.scene())
    begun = simulation.knot()
    hands = _Hands(simulation, asked["hands"])
    _proceed(hands, 0.0, asked["settle_s"])
    place, ticks, time_lost = hands.places[1].copy(), hands.ticks, hands.time_lost
    peak_N = _proceed(hands, speed, LONGEST_S, asked["force_N"])
    if peak_N < asked["force_N"]:
        raise RuntimeError(f"the pull reached {peak_N:.3g} N in {LONGEST_S:g} s, not {asked['force_N']:g} N")
    pulled, lost = hands.ticks - ticks, hands.time_lost - time_lost
    way_m = float(np.dot(hands.places[1] - place, hands.along)) * asked["hands"]
    peak_N = max(peak_N, _proceed(hands, 0.0, asked["hold_s"]))
    knot, left_N = simulation.knot(), hands.force_N()
    kept = (knot.type, knot.handedness) == (begun.type, begun.handedness)
    return {"locked": kept and left_N >= asked["least_share"] * asked["force_N"], "kept": kept, "force_left_N": left_N,
            "peak_N": peak_N, "way_m": way_m, "time_lost": lost / pulled, "knot": knot.type,
            "tick_us": 1e6 * hands.cpu_s / hands.ticks}
