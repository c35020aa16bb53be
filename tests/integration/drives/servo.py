"""A servo drive by CiA 402, without a protocol: its states, and the torque that it makes. Times are the tests' own: the bus
serves one SYNC after the other, and only the heartbeat watchdog reads a clock."""

import time

DISABLED, READY, SWITCHED_ON, ENABLED, FAULT = 0x40, 0x21, 0x23, 0x27, 0x08
SHUTDOWN, SWITCH_ON, ENABLE = 0x06, 0x07, 0x0F
FAULT_RESET = 0x80
VOLTAGE_AND_REMOTE = 0x210
HEARTBEAT_LOST = 0x8130


class Servo:
    def __init__(self):
        self.state, self.torque, self.word, self.error = DISABLED, 0, 0, 0
        self.is_deaf = False  # it makes a torque of its own, and obeys nothing but its watchdog
        self.watch_s, self.heard = 0.0, None  # of the heartbeat: 0 is off; it starts with the first heartbeat

    def command(self, word, torque):
        """A controlword and a target torque take effect, as at a SYNC."""
        if self.is_deaf:
            return
        edge, self.word = word & ~self.word, word
        if self.state == FAULT:
            if edge & FAULT_RESET:
                self.state, self.error = DISABLED, 0
        elif not word & 0x02:
            self.state = DISABLED
        elif word & 0x8F == SHUTDOWN:
            self.state = READY
        elif word & 0x8F == SWITCH_ON and self.state in (READY, SWITCHED_ON, ENABLED):
            self.state = SWITCHED_ON
        elif word & 0x8F == ENABLE and self.state in (SWITCHED_ON, ENABLED):
            self.state = ENABLED
        self.torque = torque if self.state == ENABLED else 0

    def run_away(self, torque):
        self.is_deaf, self.torque = True, torque

    def leave_operational(self):
        if self.is_deaf:
            return
        if self.state != FAULT:
            self.state = DISABLED
        self.torque = 0

    def trip(self, code):
        self.state, self.torque, self.error, self.is_deaf = FAULT, 0, code, False

    def heartbeat(self):
        if self.watch_s > 0:
            self.heard = time.monotonic()

    def misses_heartbeat(self):
        """Whether the watchdog runs out now; then it trips."""
        if self.heard is None or self.watch_s <= 0 or time.monotonic() < self.heard + self.watch_s:
            return False
        self.heard = None
        self.trip(HEARTBEAT_LOST)
        return True

    @property
    def statusword(self):
        return self.state | VOLTAGE_AND_REMOTE
