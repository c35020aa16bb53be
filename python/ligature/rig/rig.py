"""A rig under test: two hands, the controller's state and commands, the thread."""

from collections.abc import Callable
from typing import Self

import numpy as np

from ligature import Knot, Refusal
from ligature.inputs import Path, Scene, knot, number
from ligature.rig.forms import Columns, Connection, Expected, fault_files, form, scene_of
from ligature.rig.hand import Hand

STATES = ("OFF", "CALIBRATE", "IDLE", "ENGAGE", "FORCE", "BRAKE", "FAULT")
COMMANDS = ("arm", "disarm", "stop", "reset-fault", "reset-thread", "park", "calibrate")
PERIOD_S, LONGEST_S = 1e-3, 1e5
LOOK_EVERY = 10  # periods between two looks at a condition


def _connection(scene: Scene, faults: dict[int, str]) -> Connection:
    if form() == "virtual":
        from ligature.rig.virtual import Virtual

        return Virtual(scene, faults)
    if form() == "live":
        from ligature.rig.live import Live

        return Live(scene, faults)
    from ligature.rig.real import Real

    return Real(scene, faults)


class Rig:
    """A rig in the selected form (ligature.rig.use), from __enter__ to __exit__.

    scene: a Scene, a path, or the name of a shipped scene. faults: fault scripts (scenes/faults), at most one for each
    hand; their times count from the rig's start. Raises Refusal for input that the programs refuse. When entered it is
    ready and idle: drives on, encoders checked, no force.
    """

    def __init__(self, scene: Scene | Path, faults: tuple[Path, ...] | list[Path] | Path = ()) -> None:
        self.scene = scene_of(scene)
        self._connection = _connection(self.scene, fault_files(faults))
        self.left, self.right = Hand(self, 0), Hand(self, 1)
        self._latest: Columns = {}

    def __enter__(self) -> Self:
        self._connection.start()
        try:
            self.wait_for(lambda rig: rig.state != "OFF" and rig.state != "CALIBRATE", 30.0, lambda: "a rig that is ready")
        except BaseException:
            self._connection.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._connection.close()

    @property
    def dry(self) -> bool:
        """True on a real rig: nothing here can make a force."""
        return self._connection.dry

    # What a test does

    def arm(self, limit_s: float = 10.0) -> None:
        """Arms the rig, presses both dead-men and waits until both hands have full force.

        A hand gets force once it is still and its force is small. Dry form: sends nothing. Raises Expected.
        """
        if self.dry:
            return
        for hand in (self.left, self.right):
            hand.let_go()  # the controller wants a new press
        self.command("arm")
        for hand in (self.left, self.right):
            hand.press()
        self.wait_for(lambda rig: rig.left.gain == rig.right.gain == 1.0, limit_s, lambda: "full force on both hands")

    def disarm(self, limit_s: float = 5.0) -> None:
        """Removes the force in steps and waits until the rig is idle. Dry form: sends nothing. Raises Expected."""
        if not self.dry:
            self.command("disarm")
            self.wait_for(lambda rig: rig.state in ("IDLE", "FAULT"), limit_s, lambda: "an idle rig")

    def stop(self) -> None:
        """Removes the force at once and waits until no torque is sent. Dry form: sends nothing. Raises Expected."""
        if not self.dry:
            self.command("stop")
            self.wait_for(lambda rig: not rig.pushes, 1.0, lambda: "motors without torque")

    def reset_fault(self, limit_s: float = 5.0) -> None:
        """Leaves a fault and waits until the rig is idle. Dry form: sends nothing. Raises Expected."""
        if not self.dry:
            self.command("reset-fault")
            self.wait_for(lambda rig: rig.state == "IDLE" and rig.fault == 0, limit_s, lambda: "an idle rig")

    def command(self, word: str) -> None:
        """Sends arm, disarm, stop, reset-fault, reset-thread, park or calibrate, and waits for nothing further.

        Dry form: sends nothing. Raises Refusal for another word, and Expected when the rig refuses it (live).
        """
        if word not in COMMANDS:
            raise Refusal(f"command: found {word!r}, allowed {', '.join(COMMANDS)}")
        if not self.dry:
            self._connection.command(word)

    def wait(self, duration_s: float) -> None:
        """Lets the rig run so long, in its own time. Raises Refusal for a time that is not 0 .. 1e5 s."""
        self._pass(_periods(duration_s, "wait"))

    def wait_for(self, condition: "Callable[[Rig], bool]", limit_s: float = 10.0, what: Callable[[], str] | None = None) -> None:
        """Lets the rig run until condition(rig) holds; it is asked every 10 periods.

        Raises Expected after limit_s, with the text that what() gives then.
        """
        for _ in range(max(1, _periods(limit_s, "limit_s") // LOOK_EVERY)):
            if self._has_ticks() and condition(self):
                return
            self._pass(LOOK_EVERY)
        if not (self._has_ticks() and condition(self)):
            text = what() if what else "the condition"
            raise Expected(f"expected within {limit_s:g} s: {text}" + (f"; {self.state}, fault {self.fault}" if self._has_ticks() else ""))

    # What a test sees

    @property
    def state(self) -> str:
        """One of STATES."""
        return STATES[int(self._now("state"))]

    @property
    def fault(self) -> int:
        """Number of the present fault, 0 for none (docs/architecture.md)."""
        return int(self._now("fault"))

    @property
    def pushes(self) -> bool:
        """Was a torque sent to any motor in the newest period?"""
        return bool(np.any(self.left.torque_permille) or np.any(self.right.torque_permille))

    @property
    def tick(self) -> int:
        """Number of the newest period."""
        return int(self._now("tick"))

    @property
    def time_s(self) -> float:
        """Its time since the controller's start, s."""
        return float(self._now("t_s"))

    @property
    def nodes(self) -> np.ndarray:
        """n x 3, m: the newest shape of the thread (live and real: 60 a second)."""
        return self._connection.nodes()

    @property
    def ticks(self) -> Columns:
        """Every period so far, as the columns of ligature.TICK_COLUMNS: one array for each, all made in this call."""
        return self._connection.ticks()

    def knot(self) -> Knot:
        """The knot in the newest shape."""
        return knot(self.nodes)

    def _pass(self, periods: int) -> None:
        self._connection.pass_periods(periods)
        self._latest = {}

    def _has_ticks(self) -> bool:
        self._latest = self._latest or self._connection.latest()
        return len(self._latest["tick"]) > 0

    def _now(self, column: str) -> float:
        if not self._has_ticks():
            raise Expected("expected: a rig that runs; enter it with `with`")
        value = self._latest[column][-1]
        return value.item()  # type: ignore[no-any-return]


def _periods(duration_s: float, name: str) -> int:
    seconds = number(duration_s, name)
    if not 0.0 <= seconds <= LONGEST_S:
        raise Refusal(f"{name}: found {seconds:g} s, allowed 0 .. {LONGEST_S:g}")
    return round(seconds / PERIOD_S)
