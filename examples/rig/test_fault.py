"""A drive of the right hand reports an emergency: both hands lose their force at once, and a reset brings it back."""

import numpy as np
import pytest

import ligature

FROM_S = 8.0  # in the fault script below


@pytest.fixture
def rig(ligature_rig, tmp_path):
    script = tmp_path / "emergency.toml"
    text = (ligature.SCENES / "faults/emergency.toml").read_text()
    script.write_text(text.replace("from_s = 1.5", f"from_s = {FROM_S}"))
    return ligature_rig("paper.toml", faults=script)


def test_an_emergency_frees_both_hands(rig):
    rig.right.move_to((0.0, 0.0, 2.3))
    rig.right.grip()
    rig.arm()
    assert rig.pushes
    rig.wait_for(lambda r: r.fault != 0, limit_s=20.0)
    assert (rig.state, rig.fault) == ("FAULT", 12)
    rig.wait(0.5)
    ticks = rig.ticks
    torques = np.array([ticks[f"{hand}_torque_{joint}_permille"] for hand in ("left", "right") for joint in (1, 2, 3)])
    executed = (ticks["flags"] & 1) == 0  # a period that the loop lost repeats the last values
    assert np.all(torques[:, executed & (ticks["fault"] == 12)] == 0)
    rig.reset_fault()
    rig.arm()
    assert rig.state == "FORCE"
