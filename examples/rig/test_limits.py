"""However hard the thread pulls, the force at a device stays within its limit, and `stop` takes it away."""

import numpy as np
import pytest

import ligature

STRONG = {"hands.force_scale": 0.05}  # the thread's forces reach the device seventeen times as large as usual


@pytest.fixture
def rig(ligature_rig):
    return ligature_rig(ligature.Scene.load(ligature.SCENES / "paper.toml", STRONG))


def test_the_limit_holds_and_stop_frees_the_hand(rig):
    rig.left.move_to((0.0, 0.0, 2.3))
    rig.left.grip()
    rig.arm()
    rig.left.move_to((0.8, 0.3, 3.6), within_m=0.3)
    rig.wait(1.0)
    ticks = rig.ticks
    force_N = np.stack([ticks[f"left_device_f_{axis}_N"] for axis in "xyz"], axis=1)
    assert np.linalg.norm(force_N, axis=1).max() <= 3.3 * (1.0 + 1e-9)
    if not rig.dry:
        assert np.linalg.norm(force_N, axis=1).max() > 0.1, "the hand felt nothing"
    rig.stop()
    assert not rig.pushes
