"""A simulated hand moved over LCM, as by the page's host: it releases the thread when messages stop, and a recording
does not move it."""

import random
import threading
import time
import unittest

from rig import LCM_URL, STATE_ENGAGE, PageRig, run

import lcm
from ligature_msg import hand_state_t, hand_wish_t

LEFT, TIMES, LONGEST_RAMP_TICKS = 0, 100, 150  # ticks from the release of the dead-man to zero force: docs/haptics.md
ORIGIN, SCALE = (0.5, -0.4, 3.2), 20.0  # scenes/paper.toml
ON_THE_THREAD, ABOVE = (0.0, 0.0, 2.3), (0.6, 0.0, 4.4)


class Sender(threading.Thread):
    """Sends targets for the left hand 50 times per second, and stores all of them."""

    def __init__(self):
        super().__init__(daemon=True)
        self._lcm, self._lock = lcm.LCM(LCM_URL), threading.Lock()
        self._lcm.subscribe("LIGATURE_HAND_STATE", self._on_state)
        self.state, self.said, self.stop = None, [], False
        self.place, self.grip, self.dead_man, self.talks = ORIGIN, 0, 0, False
        self.session = self.owner = self.sequence = 0

    def _on_state(self, _, data):
        state = hand_state_t.decode(data)
        if state.hand == LEFT:
            self.state = state

    def take(self):
        """Takes control of the hand: the next messages have a new owner id and are numbered from 1."""
        self.session, self.owner, self.sequence = self.state.session, random.getrandbits(62) + 1, 0

    def wish(self, **other):
        wish = hand_wish_t()
        wish.session, wish.owner, wish.sequence, wish.hand = self.session, self.owner, self.sequence + 1, LEFT
        wish.grip, wish.dead_man = self.grip, self.dead_man
        wish.p_home_m = [(p - o) / SCALE for p, o in zip(self.place, ORIGIN)]
        self.sequence = wish.sequence
        for name, value in other.items():
            setattr(wish, name, value)
        return wish.encode()

    def say(self, data):
        self._lcm.publish("LIGATURE_HAND_WISH", data)

    def fall_silent(self):
        """Stops sending. @returns the last sequence number sent."""
        with self._lock:
            self.talks = False
            return self.sequence

    def run(self):
        while not self.stop:
            self._lcm.handle_timeout(20)
            time.sleep(0.01)
            with self._lock:
                if self.talks:
                    self.said.append(self.wish())
                    self.say(self.said[-1])


class PageHand(unittest.TestCase):
    def setUp(self):
        self.rig = self.enterContext(PageRig(record=True))
        self.hand = Sender()
        self.hand.start()
        self.addCleanup(setattr, self.hand, "stop", True)
        self.rig.wait_for(lambda r: r.listener.ticks and self.hand.state is not None and self.hand.state.is_live, "a hand that listens")

    def tick(self):
        return self.rig.listener.ticks[-1]

    def ticks_pass(self, count):
        until = self.tick().tick + count
        self.rig.wait_for(lambda _: self.tick().tick > until, f"{count} ticks")

    def edges(self):
        """Recent changes of the dead-man: (tick, pressed, age of the sample)."""
        ticks = self.rig.listener.ticks
        return [(b.tick, b.dead_man[LEFT], b.tpdo_age_ticks[LEFT]) for a, b in zip(ticks, ticks[1:]) if a.dead_man[LEFT] != b.dead_man[LEFT]]

    def moved_from(self, place):
        return max(abs(a - b) for a, b in zip(self.tick().p_WT_m[LEFT], place))

    def go(self, place):
        self.hand.place = place
        self.rig.wait_for(lambda _: self.moved_from(place) < 0.05, f"the hand at {place}")

    def holds_the_thread(self):
        """Takes the hand and lifts the thread with it."""
        self.hand.take()
        self.hand.talks = True
        self.go(ON_THE_THREAD)
        self.hand.grip = 1
        self.rig.wait_for(lambda _: self.tick().grasped_node[LEFT] >= 0, "a grasp")
        self.go(ABOVE)

    def say_all(self, **what):
        """Changes what is sent and waits until the device has received it; on a busy machine messages queue up."""
        for name, value in what.items():
            setattr(self.hand, name, value)
        said = self.hand.sequence + (1 if self.hand.talks else 0)
        self.rig.wait_for(lambda _: self.hand.state.sequence >= said, "the device to have heard")
        self.ticks_pass(50)

    def presses_until_force(self):
        """Presses the dead-man until the drives push. Presses again if this process was too slow, so that the device
        took its silence for a release."""
        for _ in range(50):
            self.say_all(dead_man=1)
            from_tick = self.tick().tick
            while self.tick().tick < from_tick + 2000:
                if self.tick().dead_man[LEFT] and self.tick().gain[LEFT] == 1.0 and any(self.tick().torque_permille[LEFT]):
                    return
                time.sleep(0.005)
            self.say_all(dead_man=0)
        self.fail(f"no force comes\n{self.rig.words()}")

    def test_a_hundred_silences_in_force_each_end_without_torque_by_the_dead_man(self):
        self.holds_the_thread()
        let_go = []
        for _ in range(TIMES):
            self.presses_until_force()
            last, from_tick = self.hand.fall_silent(), self.tick().tick
            self.rig.wait_for(lambda _: self.tick().tick > from_tick and not self.tick().dead_man[LEFT]
                              and self.hand.state.sequence == last and not self.hand.state.dead_man, "the dead-man let go")
            self.ticks_pass(LONGEST_RAMP_TICKS + 50)
            ticks = [t for t in self.rig.listener.ticks if t.tick > from_tick]
            released = next(t.tick for t in ticks if not t.dead_man[LEFT])
            late = [t for t in ticks if t.tick > released + LONGEST_RAMP_TICKS and any(t.torque_permille[LEFT])]
            self.assertFalse([t.tick for t in late], f"torque long after the dead-man, let go in {released}: {self.edges()}")
            let_go.append(max([t.tick for t in ticks if any(t.torque_permille[LEFT])], default=released) - released)
            del self.rig.listener.ticks[:-1000]
            self.say_all(talks=True)  # messages resume, with the dead-man pressed all along: no new press
            self.assertFalse(self.tick().dead_man[LEFT], f"pressed again by nobody: {self.edges()}")
            self.say_all(dead_man=0)
        self.assertEqual(self.tick().fault, 0, "no fault did it")
        self.assertEqual(self.tick().state, STATE_ENGAGE, "and the rig stayed armed: the next press would bring force")
        print(f"{len(let_go)} silences in force, last torque {max(let_go)} ticks after the dead-man at most")

    def test_a_recording_moves_nothing_and_nobody_else_does(self):
        self.holds_the_thread()
        other = self.hand.wish(owner=self.hand.owner ^ 2, sequence=10**9, p_home_m=[0.0, 0.0, 0.0], grip=0)
        for data in (*self.hand.said, other, b"", b"x" * 500, other[:-1]):
            self.hand.say(data)
        self.ticks_pass(1000)
        self.assertLess(self.moved_from(ABOVE), 0.1)
        self.assertGreaterEqual(self.tick().grasped_node[LEFT], 0)
        self.hand.talks = False
        self.rig.wait_for(lambda _: self.hand.state.owner == 0, "a hand that is free again")
        for data in self.hand.said:
            self.hand.say(data)
        self.ticks_pass(1000)
        self.assertLess(self.moved_from(ABOVE), 0.1)
        self.assertEqual((self.hand.state.owner, self.tick().dead_man[LEFT]), (0, 0))
        self.assertEqual(self.rig.end("firmware"), 0, self.rig.words())
        self.assertEqual(self.rig.end("recorder"), 0, self.rig.words())
        self.assertEqual(run("ligature-host", "report", self.rig.log).returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
