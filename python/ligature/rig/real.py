"""The form real, dry: a rig that somebody has started, watched without a word sent to it."""

import pathlib
import time

import numpy as np

from ligature import Refusal
from ligature.inputs import Scene
from ligature.rig.forms import Columns, Expected
from ligature.rig.hand import SIDES
from ligature.rig.network import Network

FIRST_S = 5.0  # a running rig sends its status ten times a second


class Real:
    """See forms.Connection. Asks a person, on the terminal, to move the devices; reads only."""

    dry = True

    def __init__(self, scene: Scene, faults: dict[int, str]) -> None:
        if faults:
            raise Refusal("faults: found a script, allowed none on a real rig: nothing there can play it")
        self._scene, self._network = scene, Network(scene)
        self._asked: dict[int, str] = {}
        self.nodes, self.ticks = self._network.nodes, self._network.ticks

    def start(self) -> None:
        self._network.start()
        try:
            self._meet()
            self.pass_periods(1)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self._network.end()

    def latest(self) -> Columns:
        return self._network.latest()

    def pass_periods(self, periods: int) -> None:
        self._network.pass_periods(periods)
        self._stay_dry()

    def command(self, word: str) -> None:
        raise Refusal(f"command: found {word}, allowed none on a real rig")

    def wish(self, hand: int, place: tuple[float, float, float], dead_man: bool, grip: bool) -> None:
        """Says on the terminal what a person should do with the device."""
        where = ", ".join(f"{x:.2f}" for x in place)
        line = f"{SIDES[hand]} hand: tip to ({where}) m, jaws {'closed' if grip else 'open'}"
        if self._asked.get(hand) != line:
            self._asked[hand] = line
            print(line, flush=True)

    def _meet(self) -> None:
        end_s = time.monotonic() + FIRST_S
        while self._network.status is None:
            if time.monotonic() > end_s:
                raise Expected(f"expected: a running rig; no status has come within {FIRST_S:g} s")
            time.sleep(0.02)
        runs, wanted = (pathlib.Path(path).name for path in (self._network.status.scene_file, self._scene.path))
        if runs != wanted:
            raise Refusal(f"scene: found {runs} on the rig, allowed {wanted}: load it there, or test the scene that runs")

    def _stay_dry(self) -> None:
        """The promise of this form. Somebody else may have armed the rig: then the test ends."""
        newest, status = self._network.latest(), self._network.status
        torques = [newest[f"{side}_torque_{joint}_permille"] for side in SIDES for joint in (1, 2, 3)]
        if (status is not None and status.armed) or any(np.any(torque != 0) for torque in torques):
            raise Expected("expected: a rig that is not armed; somebody has armed it, and this form tests without force")
