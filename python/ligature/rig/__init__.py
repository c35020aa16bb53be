"""Tests of a rig: the controller and two haptic devices, driven from Python and checked with assert.

    from ligature.rig import Rig

    with Rig("paper.toml") as rig:
        rig.left.move_to((0.0, 0.0, 2.3))
        rig.left.grip()
        rig.arm()
        rig.left.move_to((0.6, 0.0, 4.4))
        assert 0.01 < rig.left.force_N < 3.3

The same test runs in three forms, which pytest selects with --ligature-rig:

- virtual: the firmware's loop, CAN frames, drives, mechanics and hands in this process, on a simulated clock. Equal
  tests give equal numbers to the last bit. No network, no processes.
- live: ligature-firmware and two ligature-device as processes in real time, over LCM. Needs the extra `rig`.
- real: a rig that somebody has started, in dry form: no command and no target is sent, so it is never armed here. A
  person moves the devices as the terminal asks; forces are those that the coupling asks for, and no motor makes them.

SI units; places are in the world frame W of the scene. Source: host/lab/rig/stepped_rig.hpp (virtual).
"""

from ligature.rig.forms import Expected, form, use
from ligature.rig.hand import Hand
from ligature.rig.rig import STATES, Rig

__all__ = ["STATES", "Expected", "Hand", "Rig", "form", "use"]
