"""The form virtual: the whole rig in this process, on a simulated clock."""

import numpy as np

from ligature import _core
from ligature.inputs import Scene
from ligature.rig.forms import Columns


class Virtual:
    """See forms.Connection."""

    dry = False

    def __init__(self, scene: Scene, faults: dict[int, str]) -> None:
        self._rig = _core._Rig(scene, list(faults.values()))
        self.command, self.wish, self.nodes, self.pass_periods = self._rig.command, self._rig.wish, self._rig.nodes, self._rig.advance

    def start(self) -> None:
        self._rig.advance(1)

    def close(self) -> None:
        pass

    def latest(self) -> Columns:
        return self._rig.ticks(-1)

    def ticks(self) -> Columns:
        return self._rig.ticks(0)
