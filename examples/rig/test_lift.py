"""A hand lifts the thread and feels its weight; the other hand feels nothing.

    pytest examples/rig/test_lift.py                                     in virtual time
    scripts/private-net pytest examples/rig/test_lift.py --ligature-rig live --ligature-bin build/dev/bin
    pytest -s examples/rig/test_lift.py --ligature-rig real              a person moves the devices, without force
"""

from ligature.rig import Rig


def test_a_hand_that_lifts_the_thread_feels_its_weight():
    with Rig("paper.toml") as rig:
        rig.left.move_to((0.0, 0.0, 2.3))
        assert rig.left.grip() >= 0, "the jaws closed on nothing"
        rig.arm()
        rig.left.move_to((0.6, 0.0, 4.4))
        rig.wait(0.5)
        assert 0.01 < rig.left.force_N < 3.3
        assert rig.left.thread_force_vector_N[2] < 0.0, "the weight pulls down"
        assert rig.right.force_N == 0.0
        assert abs(rig.nodes[rig.left.node, 2] - rig.left.place_m[2]) < 0.2
        assert rig.fault == 0
