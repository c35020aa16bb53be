"""A hand as a process: three drives of somebody else's stack on a `local:` bus, and a hand that moves them.

usage: hand.py STACK PATH [TABLE] [--still] [--change INDEX:SUB=VALUE|none]..
With --still nobody holds the hand. Its standard input takes words, one a line:
    release, press     the dead-man
    fail               drive 2 falls into a fault
    run-away           drive 2 makes a torque of its own, and obeys neither controlword nor NMT
It says on standard output, one word a line with figures:
    ready                          the bus can be opened
    enabled, felt                  all drives are enabled; with all enabled, a drive makes torque
    zero BY TICKS                  the torque of all drives is zero: by the word `release`, `fail` or `run-away`, after so many SYNCs
    gone                           the controller has left the bus while torque acts
    silent MS TORQUE               so many ms later the torque is zero, or after 5 s it still is TORQUE"""

import os
import select
import sys
import time

from local_server import LocalServer

GRIP, DEAD_MAN = 1, 2
START = (-431, 1664, 892)  # counts, at the start pose of the overhand script: (0, 0, 2.3) in the world
REST = 400    # SYNCs at rest with the drives on; the dead-man is released for the first ones
TURN = 200    # counts by which the waist then turns, so that the thread pulls at the hand
FELT = 5      # per mille
WAIT_S = 5.0  # for the drives' own watchdog


class Hand:
    def __init__(self, nodes, server, shift, still):
        self.nodes, self.server, self.shift, self.still = nodes, server, shift, still
        self.pressed, self.syncs, self.syncs_on, self.told, self.asked = True, 0, 0, set(), None
        self.synced_at, self.gone_at, self.request = 0.0, None, getattr(nodes, "REQUEST", 0x080)  # the frame that asks for a sample

    def say(self, *words):
        print(*words, flush=True)

    def once(self, word):
        if word not in self.told:
            self.told.add(word)
            self.say(word)

    @property
    def torque(self):
        return max(abs(s.torque) for s in self.nodes.servos)

    @property
    def is_on(self):
        return all(s.state == 0x27 for s in self.nodes.servos)

    def on_sync(self, now):
        self.syncs, self.synced_at = self.syncs + 1, now
        if self.is_on or "felt" in self.told:
            self.syncs_on += 1
        else:
            self.syncs_on = 0  # start-up may have switched the drives on and off again
        turned = 0 if self.still else max(0, min((self.syncs_on - REST) // 4, TURN))
        held = 0 if self.still else GRIP | DEAD_MAN if self.pressed and self.syncs_on > 50 else GRIP
        self.nodes.place((START[0] + turned, *START[1:]), held << self.shift)
        self.nodes.on_sync()
        if self.is_on:  # a drive that damps makes torque, too, when start-up tries its watchdog
            self.once("enabled")
            if self.torque > FELT:
                self.once("felt")

    def look_at_torque(self, now):
        """After each frame: some controllers send no more SYNCs after a fault. Then each millisecond counts as one."""
        if self.asked and self.torque == 0:
            self.say("zero", self.asked[0], self.syncs - self.asked[1] + int(1000 * (now - self.synced_at)))
            self.asked = None

    def order(self, word):
        if word == "fail":
            self.nodes.fail(2)
        elif word == "run-away":
            self.nodes.run_away(2)
        else:
            self.pressed = word == "press"
        if word == "press":
            self.told.discard("felt")
        else:
            self.asked = (word, self.syncs)

    def look_at_controller(self, now):
        """The controller has left: waits for the drives' own watchdog, then forgets the run."""
        if self.server.controller is not None or self.syncs == 0:
            return
        if self.gone_at is None:
            self.gone_at = now
            if self.torque:
                self.say("gone")
        if self.torque and now < self.gone_at + WAIT_S:
            return
        self.say("silent", round(1000 * (now - self.gone_at)), self.torque)
        self.syncs, self.gone_at, self.asked, self.pressed = 0, None, None, True
        self.told.clear()
        self.nodes.clear()

    def live(self):
        self.say("ready")
        while True:
            frame = self.server.receive(0.005, sys.stdin)
            now = time.monotonic()
            if frame is None and not self.listen():
                return
            if frame and frame[0] == self.request:
                self.on_sync(now)
            elif frame:
                self.nodes.on_frame(*frame, now)
            self.nodes.poll(now)
            self.look_at_torque(now)
            self.look_at_controller(now)

    def listen(self):
        """Takes a word of standard input if there is one. @return False at its end."""
        if not select.select([sys.stdin], [], [], 0)[0]:
            return True
        word = sys.stdin.readline()
        if word:
            self.order(word.strip())
        return bool(word)


def changes_of(args):
    for flag, text in zip(args[::2], args[1::2], strict=True):
        assert flag == "--change", flag
        at, value = text.split("=")
        index, sub = at.split(":")
        yield (int(index, 16), int(sub, 16)), None if value == "none" else int(value)


def ask_for_priority():
    """As `ligature-device --rt`: on a busy machine a hand that cannot keep up with 1000 SYNCs a second falls ever further behind.
    Lower than the firmware; if it is refused, the hand runs without."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(10))
    except PermissionError:
        pass


def main():
    ask_for_priority()
    stack, path, *rest = sys.argv[1:]
    table = rest.pop(0) if rest and not rest[0].startswith("--") else None
    still = "--still" in rest
    changes = changes_of([r for r in rest if r != "--still"])
    module = __import__(stack)
    server = LocalServer(path)
    nodes = module.Nodes(server, table, list(changes))
    Hand(nodes, server, 16 if stack == "durand_nodes" else 0, still).live()


if __name__ == "__main__":
    main()
