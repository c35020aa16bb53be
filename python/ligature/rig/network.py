"""What a rig of processes sends over LCM, and the targets for its simulated hands. Runs in a thread of its own."""

import random
import struct
import threading
import time

import lcm
import numpy as np
from ligature_msg import hand_state_t, hand_wish_t, status_t, thread_t

from ligature import Refusal, _core
from ligature.inputs import Scene
from ligature.rig.forms import Columns, Expected
from ligature.rig.hand import SIDES

URL = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"  # protocol/lcm/default_url.hpp
WISH_EVERY_S = 0.02
SILENCE_S = 10.0  # a rig of which nothing is heard for so long is not there


class Network(threading.Thread):
    """Keeps the ticks, the newest shape and status, and the state of steered hands; sends targets once take() is called."""

    def __init__(self, scene: Scene, url: str = URL) -> None:
        super().__init__(daemon=True, name="ligature.rig")
        self._lcm = _opened(url)
        self._scene, self._heard, self._ended = scene, threading.Condition(), False
        self._batches: list[bytes] = []
        self._periods = 0
        self._shape = b""
        self.status: status_t | None = None
        self.hands: dict[int, hand_state_t] = {}
        self._claims: dict[int, list[int]] = {}  # hand: session, owner, sequence
        self._wishes: dict[int, tuple[tuple[float, float, float], bool, bool]] = {}
        self._subscriptions = []
        for channel, take in (("TICKS", self._on_ticks), ("THREAD", self._on_shape), ("STATUS", self._on_status), ("HAND_STATE", self._on_hand)):
            self._subscriptions.append(self._lcm.subscribe(f"LIGATURE_{channel}", take))
            self._subscriptions[-1].set_queue_capacity(1000)

    def run(self) -> None:
        due_s = 0.0
        while not self._ended:
            try:
                self._lcm.handle_timeout(5)
            except (ValueError, EOFError, struct.error):  # somebody's message that is none of ours
                continue
            if time.monotonic() >= due_s:
                due_s = time.monotonic() + WISH_EVERY_S
                with self._heard:
                    for hand in self._claims:
                        self._say(hand)

    def end(self) -> None:
        self._ended = True
        if self.is_alive():
            self.join()
        while self._subscriptions:  # LCM's object keeps this one alive by them, where no garbage collector looks
            self._lcm.unsubscribe(self._subscriptions.pop())

    def take(self, hand: int) -> None:
        """Takes a simulated hand: from now on it follows wish()."""
        with self._heard:
            self._claims[hand] = [self.hands[hand].session, random.getrandbits(62) + 1, 0]

    def wish(self, hand: int, place: tuple[float, float, float], dead_man: bool, grip: bool) -> None:
        """Sends a target and waits until the device has it: a dead-man counts only after a message with it released."""
        with self._heard:
            self._wishes[hand] = (place, dead_man, grip)
            sent = self._say(hand)
            if not self._heard.wait_for(lambda: self._takes(hand, sent), SILENCE_S):
                raise Expected(f"expected: a {SIDES[hand]} hand that follows this test; its device has not answered for {SILENCE_S:g} s")

    def latest(self) -> Columns:
        with self._heard:
            newest = self._batches[-1:]
        return _core._ticks_of(newest)

    def ticks(self) -> Columns:
        with self._heard:
            batches = list(self._batches)
        return _core._ticks_of(batches)

    def nodes(self) -> np.ndarray:
        if not self._shape:
            raise Expected("expected: a shape of the thread; none has come")
        return np.array(thread_t.decode(self._shape).p_W_m, dtype=np.float64)

    def pass_periods(self, periods: int) -> None:
        """Waits until the newest period is so many later. Raises Expected when nothing comes for 10 s."""
        with self._heard:
            until = self._periods + periods
            while self._periods < until:
                before = self._periods
                if not self._heard.wait_for(lambda last=before: self._periods != last, SILENCE_S):
                    raise Expected(f"expected: a rig that sends; nothing has come for {SILENCE_S:g} s")

    def _on_ticks(self, _: str, data: bytes) -> None:
        newest = _core._ticks_of([data])["tick"]
        if len(newest) == 0:
            return
        with self._heard:
            if not self._batches:
                self._first = int(newest[0])
            self._batches.append(data)
            self._periods = int(newest[-1]) - self._first + 1
            self._heard.notify_all()

    def _on_shape(self, _: str, data: bytes) -> None:
        self._shape = data

    def _on_status(self, _: str, data: bytes) -> None:
        self.status = status_t.decode(data)

    def _on_hand(self, _: str, data: bytes) -> None:
        state = hand_state_t.decode(data)
        with self._heard:
            self.hands[state.hand] = state
            self._heard.notify_all()

    def _takes(self, hand: int, sequence: int) -> bool:
        state = self.hands[hand]
        return [state.session, state.owner] == self._claims[hand][:2] and state.sequence >= sequence

    def _say(self, hand: int) -> int:
        """Sends the newest target of one hand. The caller holds the lock. @returns the message's number."""
        claim = self._claims[hand]
        place, dead_man, grip = self._wishes.get(hand, (tuple(self._scene.workspace_origin_m), False, False))
        claim[2] += 1
        wish = hand_wish_t()
        wish.utime = time.time_ns() // 1000
        wish.session, wish.owner, wish.sequence = claim
        wish.hand, wish.dead_man, wish.grip = hand, dead_man, grip
        wish.p_home_m = [(p - o) / self._scene.workspace_scale for p, o in zip(place, self._scene.workspace_origin_m, strict=True)]
        self._lcm.publish("LIGATURE_HAND_WISH", wish.encode())
        return claim[2]


def _opened(url: str) -> lcm.LCM:
    try:
        return lcm.LCM(url)
    except (RuntimeError, OSError, ValueError):
        raise Refusal(f"ligature.rig: the network {url} cannot be opened; allowed: inside scripts/private-net, "
                      "or with a multicast route on lo") from None
