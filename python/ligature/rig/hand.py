"""One hand of a rig: what a test makes it do, and what it sees of it."""

from typing import TYPE_CHECKING

import numpy as np

from ligature import Refusal, _core
from ligature.inputs import number, numbers

if TYPE_CHECKING:
    from ligature.rig.rig import Rig

SIDES = ("left", "right")
NEAR_OF_DEVICE_M = 0.0025  # a hand holds the device as by a spring, so that forces keep it off its target


class Hand:
    """The left or the right hand. Every reading is of the newest period."""

    def __init__(self, rig: "Rig", index: int) -> None:
        self._rig, self._index, self.side = rig, index, SIDES[index]
        self._place: tuple[float, float, float] | None = None
        self._pressed = self._closed = False

    def move_to(self, place: object, within_m: float | None = None, limit_s: float = 20.0) -> None:
        """Moves the hand and waits until the measured tip is near. The motion is that of an unhurried arm.

        place: x, y, z in the thread's world, m. within_m: distance that is near enough, m; None: 2.5 mm times the scene's
        workspace_scale, which is 2.5 mm at the device. limit_s: longest time that the motion may take, s. Raises the
        exception Refusal for a place that the device does not reach, and Expected when the hand does not come near.
        """
        to = numbers(place, f"{self.side}.move_to")
        if to.shape != (3,):
            raise Refusal(f"{self.side}.move_to: found an array of shape {to.shape}, allowed x, y, z")
        if why := _core._out_of_reach(self._rig.scene, tuple(to)):
            raise Refusal(f"{self.side}.move_to: {why}")
        near_m = NEAR_OF_DEVICE_M * self._rig.scene.workspace_scale if within_m is None else number(within_m, "within_m")
        self._ask(place=tuple(to))
        self._rig.wait_for(lambda _: bool(np.linalg.norm(self.place_m - to) <= near_m), limit_s,
                           lambda: f"the {self.side} hand at {_text(to)} m (now {_text(self.place_m)})")

    def grip(self, limit_s: float = 5.0) -> int:
        """Closes the jaws. Returns the node of the thread that they hold, -1 for none. Raises Expected."""
        self._close(True, limit_s)
        self._rig.wait(0.02)  # the thread answers in the period after the next
        return self.node

    def open(self, limit_s: float = 5.0) -> None:
        """Opens the jaws. Raises Expected."""
        self._close(False, limit_s)
        self._rig.wait(0.02)

    def press(self, limit_s: float = 5.0) -> None:
        """Presses the dead-man button. Force comes only if the rig is armed. Raises Expected. Dry form: does nothing."""
        self._press(True, limit_s)

    def let_go(self, limit_s: float = 5.0) -> None:
        """Releases the dead-man button; the force is gone within 0.15 s. Raises Expected."""
        self._press(False, limit_s)

    @property
    def place_m(self) -> np.ndarray:
        """x, y, z of the tool's tip, m, measured by the controller."""
        return self._vector("p_WT", "m")

    @property
    def velocity_m_per_s(self) -> np.ndarray:
        """Its filtered velocity, m/s."""
        return self._vector("v_WT", "m_per_s")

    @property
    def force_vector_N(self) -> np.ndarray:
        """x, y, z of the force at the device's tip, N, after all limits; + pushes the hand along the axis.

        Dry form: the force that the coupling asks for.
        """
        return self._vector("wish_f" if self._rig.dry else "device_f", "N")

    @property
    def force_N(self) -> float:
        """Magnitude of force_vector_N, N."""
        return float(np.linalg.norm(self.force_vector_N))

    @property
    def thread_force_vector_N(self) -> np.ndarray:
        """x, y, z of the thread's force on the hand, N, in world units: before hands.force_scale."""
        return self._vector("world_f", "N")

    @property
    def torque_permille(self) -> np.ndarray:
        """Torques sent to the three joints, per mille of the rated torque."""
        return np.array([self._value(f"torque_{joint}_permille") for joint in (1, 2, 3)], dtype=np.int64)

    @property
    def gain(self) -> float:
        """Share of the coupling's force that is let through: 1 in full force."""
        return float(self._value("gain"))

    @property
    def node(self) -> int:
        """Node of the thread that the hand holds, -1 for none."""
        return int(self._value("node"))

    @property
    def closed(self) -> bool:
        """Are the jaws closed?"""
        return bool(self._value("grip"))

    @property
    def pressed(self) -> bool:
        """Is the dead-man pressed?"""
        return bool(self._value("dead_man"))

    def _close(self, closed: bool, limit_s: float) -> None:
        self._ask(closed=closed)
        word = "closed" if closed else "open"
        self._rig.wait_for(lambda _: self.closed == closed, limit_s, lambda: f"the {self.side} hand's jaws {word}")

    def _press(self, pressed: bool, limit_s: float) -> None:
        if self._rig.dry:
            return
        self._ask(pressed=pressed)
        word = "pressed" if pressed else "let go"
        self._rig.wait_for(lambda _: self.pressed == pressed, limit_s, lambda: f"the {self.side} hand's dead-man {word}")

    def _ask(self, place: tuple[float, float, float] | None = None, pressed: bool | None = None, closed: bool | None = None) -> None:
        self._place = place if place is not None else self._place or tuple(self._rig.scene.workspace_origin_m)
        self._pressed = self._pressed if pressed is None else pressed
        self._closed = self._closed if closed is None else closed
        self._rig._connection.wish(self._index, self._place, self._pressed, self._closed)

    def _value(self, name: str) -> float:
        return self._rig._now(f"{self.side}_{name}")

    def _vector(self, quantity: str, unit: str) -> np.ndarray:
        return np.array([self._value(f"{quantity}_{axis}_{unit}") for axis in "xyz"])


def _text(place: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.3f}" for x in place) + ")"
