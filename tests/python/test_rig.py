"""ligature.rig in virtual time: what it refuses, what it says when something does not come, and that it repeats."""

import threading

import numpy as np
import pytest

import ligature
from conftest import SCENES
from ligature.rig import Expected, Rig, form, use

THREAD, ABOVE = (0.0, 0.0, 2.3), (0.6, 0.0, 4.4)


@pytest.fixture(autouse=True)
def virtual():
    before = form()
    use("virtual")
    yield
    use(before)


def lift():
    with Rig("paper.toml") as rig:
        rig.left.move_to(THREAD)
        rig.left.grip()
        rig.arm()
        rig.left.move_to(ABOVE)
        rig.wait(0.3)
    return rig


def test_equal_tests_give_equal_numbers():
    first, second = lift(), lift()
    assert first.tick == second.tick > 1000
    assert np.array_equal(first.nodes, second.nodes)
    for column, values in first.ticks.items():
        assert np.array_equal(values, second.ticks[column]), column


def test_readings_are_those_of_the_columns():
    rig = lift()
    ticks = rig.ticks
    assert np.array_equal(ticks["tick"], np.arange(len(ticks["tick"])))
    assert set(ticks) == set(ligature.TICK_COLUMNS)
    assert rig.left.force_N == np.linalg.norm([ticks[f"left_device_f_{axis}_N"][-1] for axis in "xyz"]) > 0.01
    assert rig.left.node == ticks["left_node"][-1] >= 0
    assert (rig.state, rig.left.closed, rig.left.pressed, rig.right.closed, rig.right.node) == ("FORCE", True, True, False, -1)
    assert np.all(np.abs(rig.left.place_m - ABOVE) < 0.05)
    assert rig.time_s == rig.tick / 1000
    assert rig.knot().type == "0_1"


def test_what_does_not_come_is_an_assertion_with_its_name():
    with Rig("paper.toml") as rig:
        with pytest.raises(Expected, match=r"expected within 0.1 s: the left hand at \(0.600, 0.000, 4.400\) m \(now "):
            rig.left.move_to(ABOVE, limit_s=0.1)
        with pytest.raises(AssertionError, match="expected within 0.05 s: the condition"):
            rig.wait_for(lambda r: False, limit_s=0.05)
        before = rig.tick
        rig.wait(0.123)
        assert rig.tick == before + 123


def test_force_comes_only_when_armed_and_goes_when_disarmed():
    with Rig("paper.toml") as rig:
        rig.left.press()
        rig.wait(1.0)
        assert (rig.state, rig.pushes) == ("IDLE", False)
        rig.arm()
        assert rig.state == "FORCE"
        rig.right.let_go()
        rig.wait(0.3)
        assert (rig.left.gain, rig.right.gain) == (1.0, 0.0)
        rig.disarm()
        assert (rig.state, rig.pushes, rig.left.gain) == ("IDLE", False, 0.0)


@pytest.mark.parametrize("call,says", [
    (lambda r: r.left.move_to((100.0, 0.0, 0.0)), "left.move_to: found (100, 0, 0) m, out of the device's reach"),
    (lambda r: r.right.move_to((float("nan"), 0.0, 0.0)), "right.move_to: found (nan, 0, 0) m, out of the device's reach"),
    (lambda r: r.left.move_to((1.0, 2.0)), "left.move_to: found an array of shape (2,), allowed x, y, z"),
    (lambda r: r.left.move_to("there"), "left.move_to: found an array of"),
    (lambda r: r.wait(-1.0), "wait: found -1 s, allowed 0 .. 100000"),
    (lambda r: r.wait(float("nan")), "wait: found nan s, allowed 0 .. 100000"),
    (lambda r: r.wait_for(lambda _: False, float("inf")), "limit_s: found inf s, allowed 0 .. 100000"),
    (lambda r: r.left.grip("soon"), "limit_s: found str, allowed a number"),
    (lambda r: r.command("set"), "command: found 'set', allowed arm, disarm"),
    (lambda r: use("simulated"), "form: found 'simulated', allowed virtual, live, real"),
])
def test_refusals_leave_the_rig_as_it_was(call, says):
    with Rig("paper.toml") as rig:
        before = rig.tick
        with pytest.raises(ligature.Refusal) as refused:
            call(rig)
        assert str(refused.value).startswith(says)
        assert rig.tick == before and form() == "virtual"


@pytest.mark.parametrize("scene,faults,says", [
    ("none.toml", (), "none.toml"),
    ("paper.toml", "none.toml", "none.toml"),
    ("paper.toml", [SCENES / "faults/emergency.toml"] * 2, "found a second fault for the right hand, allowed one for each"),
])
def test_a_rig_that_cannot_be_is_refused(scene, faults, says):
    with pytest.raises(ligature.Refusal, match=says):
        Rig(scene, faults)


def test_a_rig_that_is_not_entered_says_so():
    with pytest.raises(Expected, match="enter it with `with`"):
        Rig("paper.toml").left.force_N


def test_real_rigs_play_no_faults_and_live_ones_need_their_programs(tmp_path):
    use("real")
    with pytest.raises(ligature.Refusal, match="nothing there can play it"):
        Rig("paper.toml", SCENES / "faults/emergency.toml")
    use("live", tmp_path)
    with pytest.raises(ligature.Refusal, match="ligature-firmware: not found in .*--ligature-bin"):
        Rig("paper.toml")


def test_one_thread_at_a_time_and_others_keep_running():
    with Rig("paper.toml") as rig:
        refused = []

        def disturb():
            while not refused and busy.is_alive():
                try:
                    rig._connection.wish(0, ABOVE, False, False)
                except RuntimeError as why:
                    refused.append(str(why))

        busy = threading.Thread(target=rig.wait, args=(3.0,))
        busy.start()
        disturb()
        busy.join()
        assert refused == ["this rig is running in another thread"]


def test_a_scene_s_overrides_and_text_count():
    weak = ligature.Scene.load(SCENES / "paper.toml", {"hands.force_scale": 0.0})
    with Rig(weak) as rig:
        rig.left.move_to(THREAD)
        rig.left.grip()
        rig.arm()
        rig.left.move_to(ABOVE)
        assert rig.left.force_N == 0.0
    assert Rig(ligature.Scene.parse((SCENES / "paper.toml").read_text())).scene.nodes == 50
