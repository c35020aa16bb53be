"""How a fault is left, in virtual time and with a rig of processes: the same test, by ligature.rig.

A rig that has faulted gets force back only by a reset, a new arming and a new press of the dead-man."""

import numpy as np
import pytest

import ligature

FROM_S, CODE = 8.0, 12


@pytest.fixture
def rig(ligature_rig, tmp_path):
    script = tmp_path / "emergency.toml"
    script.write_text((ligature.SCENES / "faults/emergency.toml").read_text().replace("from_s = 1.5", f"from_s = {FROM_S}"))
    return ligature_rig("paper.toml", faults=script)


def test_a_fault_is_left_by_reset_arm_and_a_new_press(rig):
    rig.arm()
    assert (rig.left.gain, rig.right.gain) == (1.0, 1.0)
    rig.wait_for(lambda r: r.fault == CODE, limit_s=20.0)
    faulted = rig.tick
    rig.wait(0.2)
    assert rig.state == "FAULT", "it stays until it is reset"
    rig.reset_fault()
    rig.wait(0.5)
    assert rig.state == "IDLE", "and is not armed by the reset"
    rig.arm()
    back = rig.tick
    assert (rig.fault, rig.state, rig.left.gain, rig.right.gain) == (0, "FORCE", 1.0, 1.0)
    ticks = rig.ticks
    for side in ("left", "right"):
        pressed = np.flatnonzero((ticks["tick"] > faulted) & (ticks[f"{side}_dead_man"] == 1) & (ticks["state"] >= 3) & (ticks["state"] <= 4))
        between = (ticks["tick"] > faulted) & (ticks["tick"] < ticks["tick"][pressed[0]])
        assert np.all(ticks[f"{side}_gain"][between] == 0.0), "force before a new press"
    assert back > faulted


def test_a_stop_is_left_by_arm_and_a_new_press(ligature_rig):
    rig = ligature_rig("paper.toml")
    rig.arm()
    rig.stop()
    rig.command("arm")
    rig.wait(1.0)
    assert rig.left.pressed and rig.right.pressed
    assert (rig.left.gain, rig.right.gain) == (0.0, 0.0), "the old press counts no more"
    rig.arm()
    assert (rig.left.gain, rig.right.gain) == (1.0, 1.0)
