"""Two simulated hands that tie by looking at what the rig publishes on LCM, as processes."""

import time
import unittest

from rig import HANDS, LCM_URL, STATE_FORCE, Rig

import lcm
from ligature_msg import tick_batch_t

LEFT, RIGHT = 0, 1
ELSEWHERE = "udpm://239.255.76.68:7668?ttl=0"


class TyingHands(unittest.TestCase):
    def test_they_see_the_thread_and_take_it(self):
        rig = self.enterContext(Rig(operator="tie:overhand:3"))
        rig.wait_for(lambda r: r.state_is(STATE_FORCE), "force")
        garbage = lcm.LCM(LCM_URL)
        for data in (b"", b"x" * 500, rig.listener.status.encode()):
            for channel in ("LIGATURE_THREAD", "LIGATURE_TICKS"):
                garbage.publish(channel, data)
        for hand in (LEFT, RIGHT):
            rig.wait_for(lambda r, hand=hand: r.listener.ticks[-1].grasped_node[hand] >= 0, f"a grasp of the {HANDS[hand]} hand", bound_s=60)
        self.assertEqual(rig.listener.ticks[-1].fault, 0, rig.words())
        for hand in HANDS:
            self.assertTrue(rig.alive(hand), rig.words())
            self.assertNotIn("ticks lost", rig.said(hand))

    def test_a_hand_that_hears_nothing_presses_nothing(self):
        rig = self.enterContext(Rig(operator="tie:overhand:3", extra=("--lcm-url", ELSEWHERE)))
        heard = lcm.LCM(ELSEWHERE)
        ticks = []
        heard.subscribe("LIGATURE_TICKS", lambda _, data: ticks.extend(tick_batch_t.decode(data).ticks)).set_queue_capacity(1000)
        end = time.monotonic() + 60
        while not (ticks and ticks[-1].tick > 3000):
            self.assertLess(time.monotonic(), end, rig.words())
            heard.handle_timeout(100)
        self.assertFalse([t.tick for t in ticks if any(t.dead_man) or any(t.gain)])


if __name__ == "__main__":
    unittest.main(verbosity=2)
