"""A fake rig for tests of the page: publishes messages as ligature-firmware does, controlled by lines on standard input.

    fault N     latch fault N        knot | unknot | square   the thread's shape   spike F   one tick with F newton
    set KEY=V   the scene runs with this override         friction F   as set by somebody else
    limit BITS  force limits of the left hand   clutch B   left tool parked   degrade N   reduced accuracy of the solver
    propagation L R   the paper's condition at each hand   arm   go to FORCE
    hands       two simulated hands listen, as `ligature-device --operator page`
    quiet       stop publishing      go              publish again             restart [T]   another session, from tick T
It prints "ready" when it publishes, "armed" after each `arm`, "command NAME" for each command received, and "wish left"
or "wish left leaves" for each message to a hand that the hand obeys. All values are made up.
"""

import argparse
import math
import os
import random
import select
import sys
import time

import lcm
from ligature_msg import ack_t, command_t, event_t, hand_state_t, hand_wish_t, offer_t, parameter_t, preview_t, status_t, thread_t, tick_batch_t, tick_t

STATES = ["OFF", "CALIBRATE", "IDLE", "ENGAGE", "FORCE", "BRAKE", "FAULT"]
KNOT_NODES, RADIUS_M = 120, 0.03
COMMANDS = {1: "arm", 2: "disarm", 3: "stop", 4: "reset-fault", 5: "reset-thread", 6: "load-scene", 7: "set"}
SCENE = """[suture]
model = "paper-4"
nodes = 120
length_m = 5.0
radius_m = 0.03
[world]
fixed = [{node = 0, position_m = [-1.6, 0.0, 2.6]}]
desk_height_m = 0.0
"""


def trefoil(n):
    """The long trefoil (t^3 - 3t, t^4 - 4t^2, t^5 - 10t) [Shastri 1992] with extended ends."""
    points = []
    for i in range(n):
        t = -2.12 + 4.24 * i / (n - 1)
        points.append([(t**3 - 3 * t) * 0.33, (t**4 - 4 * t * t) * 0.09, 1.7 + (t**5 - 10 * t) * 0.06])
    return points


def unknot(n):
    """A hanging plane curve."""
    return [[-1.6 + 3.2 * i / (n - 1), 0.0, 2.6 - 1.8 * math.sin(math.pi * i / (n - 1))] for i in range(n)]


def square(n):
    """Two trefoils in a row, one the mirror image of the other."""
    first = trefoil(n // 2)
    return first + [[x + 3.0, 0.4 - y, z + 3.5] for x, y, z in trefoil(n - n // 2)]


class Rig:
    def __init__(self, url):
        self.lcm = lcm.LCM(url)
        self.lcm.subscribe("LIGATURE_COMMAND", self.on_command)
        self.lcm.subscribe("LIGATURE_HAND_WISH", self.on_wish)
        self.hands = []
        self.state, self.fault, self.armed = 2, 0, False
        self.shape, self.spike, self.quiet = unknot(KNOT_NODES), 0.0, False
        self.limit, self.clutch, self.degraded, self.conditions = 0, 0, 0, [0, 0]
        self.scene, self.friction, self.overrides = "fake.toml", 0.3, []
        self.restart()

    def restart(self, tick=0):
        self.session, self.tick, self.challenges = int(time.time() * 1e6), tick, {}

    def on_command(self, _, data):
        command = command_t.decode(data)
        kind = COMMANDS.get(command.kind, "?")
        if kind not in ("disarm", "stop") and not self.is_fresh(command):
            return
        print("command", kind, command.text, flush=True)
        ack = ack_t()
        ack.id, ack.session, ack.accepted, ack.reason = command.id, self.session, 1, "done"
        if kind == "arm" and self.fault:
            ack.accepted, ack.reason = 0, f"fault {self.fault} is latched"
        elif kind == "arm":
            self.go_to(4)
        elif kind in ("disarm", "stop"):
            self.go_to(2 if not self.fault else 6)
        elif kind == "reset-fault":
            self.fault = 0
            self.go_to(2)
        elif kind == "load-scene" and self.state not in (0, 2):
            ack.accepted, ack.reason = 0, "force may flow: disarm first"
        elif kind == "load-scene":
            self.scene = command.text
            ack.reason = f"scene {command.text} loaded"
            self.event(6, 0, ack.reason)
        elif kind == "set" and not 0 <= command.value <= 2:
            ack.accepted, ack.reason = 0, f"{command.text}: found {command.value:g}, allowed 0 .. 2"
        elif kind == "set":
            self.friction = command.value
            ack.reason = f"{command.text}={command.value:g}"
            self.event(6, 0, ack.reason)
        self.lcm.publish("LIGATURE_ACK", ack.encode())
        self.publish_offer()

    def on_wish(self, _, data):
        """As sim_device/page/holding.hpp: a hand obeys the first sender of its session, which ends when that one leaves."""
        wish = hand_wish_t.decode(data)
        hand = self.hands[wish.hand]
        if wish.session != hand.session or hand.owner not in (0, wish.owner):
            print("stranger's wish", flush=True)
            return
        hand.owner = wish.owner
        print("wish", ("left", "right")[wish.hand], "leaves" if wish.leaves else "", flush=True)
        if wish.leaves:
            hand.session, hand.owner = hand.session + 1, 0

    def publish_hands(self):
        for hand in self.hands:
            self.lcm.publish("LIGATURE_HAND_STATE", hand.encode())

    def is_fresh(self, command):
        """As in the firmware's command gate: a command without a challenge is answered with one."""
        if command.challenge and self.challenges.pop(command.id, 0) == command.challenge:
            return True
        ack = ack_t()
        ack.id, ack.session, ack.reason = command.id, self.session, "replayed"
        if not command.challenge:
            ack.challenge = self.challenges[command.id] = random.getrandbits(62) + 1
        self.lcm.publish("LIGATURE_ACK", ack.encode())
        return False

    def publish_offer(self):
        offer = offer_t()
        offer.session, offer.scenes, offer.scene_count = self.session, ["desk.toml", "fake.toml"], 2
        for name, points in (("lies on a desk", [[0.1 * math.cos(i), 0.1 * math.sin(i), 0.0] for i in range(30)]), ("hangs", [[0, 0, 1], [0, 0, 0.5]])):
            preview = preview_t()
            preview.about, preview.facts, preview.p_W_m, preview.point_count = f"This one {name}.", f"rod, {len(points)} nodes", points, len(points)
            preview.desk_height_m = 0.0 if "desk" in name else math.nan
            offer.previews.append(preview)
        friction, scale = parameter_t(), parameter_t()
        friction.key, friction.name, friction.value, friction.lowest, friction.highest = "contact.friction", "friction", self.friction, 0.0, 2.0
        scale.key, scale.name, scale.value, scale.lowest, scale.highest = "hands.force_scale", "force scale", 0.003, 0.00075, 0.012
        offer.parameters, offer.parameter_count = [friction, scale], 2
        self.lcm.publish("LIGATURE_OFFER", offer.encode())

    def go_to(self, state):
        if state != self.state:
            self.event(1, state, f"{STATES[self.state]} -> {STATES[state]}")
        self.state, self.armed = state, state in (3, 4)

    def event(self, kind, code, text, hand=-1):
        event = event_t()
        event.tick, event.kind, event.hand, event.code, event.text = self.tick, kind, hand, code, text
        self.lcm.publish("LIGATURE_EVENT", event.encode())

    def obey(self, line):
        word, _, value = line.strip().partition(" ")
        if word == "fault":
            self.fault = int(value)
            self.event(2, self.fault, f"fault {self.fault}")
            self.go_to(6)
        elif word in SHAPES:
            self.shape = SHAPES[word](KNOT_NODES)
        elif word == "friction":
            self.friction = float(value)
            self.publish_offer()
        elif word == "set":
            self.overrides.append(value)
        elif word == "spike":
            self.spike = float(value)
        elif word == "limit":
            self.limit = int(value)
        elif word == "clutch":
            self.clutch = int(value)
        elif word == "hands":
            self.hands = [hand_state_t(), hand_state_t()]
            for index, hand in enumerate(self.hands):
                hand.hand, hand.session, hand.is_live = index, 1 + index, 1
        elif word == "propagation":
            self.conditions = [int(code) for code in value.split()]
        elif word == "degrade":
            self.degraded = int(value)
        elif word == "arm":
            self.fault = 0
            self.go_to(4)
            print("armed", flush=True)
        elif word in ("quiet", "go"):
            self.quiet = word == "quiet"
        elif word == "restart":
            self.restart(int(value or 0))

    def one_tick(self):
        tick = tick_t()
        t = self.tick * 1e-3
        tick.tick, tick.scheduled_ns = self.tick, self.tick * 1_000_000
        tick.wakeup_latency_ns = 3000 + (self.tick * 7919 % 4000) + (60_000 if self.tick % 997 == 0 else 0)
        tick.control_ns, tick.execution_ns = 90_000, 260_000 + 20_000 * (self.tick % 5)
        tick.state, tick.fault, tick.flags = self.state, self.fault, 0
        held = [40, 80]
        gain = 1.0 if self.state == 4 else 0.0
        for hand in range(2):
            tick.p_WT_m[hand] = list(self.shape[held[hand]])
            force = gain * (1.1 + 0.7 * math.sin(1.3 * t + 2 * hand)) + (self.spike if hand == 0 else 0.0)
            tick.f_device_N[hand] = [force * (-0.6 if hand == 0 else 0.8), force * 0.1 * math.sin(3 * t), force * 0.6]
            tick.grasped_node[hand], tick.grip[hand], tick.dead_man[hand] = held[hand], 1, int(self.armed)
        if self.spike > 3.3:
            tick.flags |= 16
        tick.min_gap_m = 0.01
        tick.bus_load = [0.62, 0.64 + 0.02 * math.sin(t)]
        tick.port_energy_J, tick.dissipated_J = [0.02 * math.sin(t), 0.01 * math.cos(t)], [1e-4 * t, 2e-4 * t]
        tick.f_world_N = [[200 * f for f in hand] for hand in tick.f_device_N]
        tick.limits, tick.clutch, tick.degradation = [self.limit, 0], [self.clutch, 0], self.degraded
        tick.gain, tick.heat, tick.propagation = [gain, gain], [0.1, 0.2], self.conditions
        self.spike = 0.0
        self.tick += 1
        return tick

    def publish(self, due_ticks):
        batch = tick_batch_t()
        batch.session = self.session
        batch.ticks = [self.one_tick() for _ in range(due_ticks)]
        batch.count = len(batch.ticks)
        self.lcm.publish("LIGATURE_TICKS", batch.encode())
        thread = thread_t()
        thread.tick, thread.radius_m, thread.count = self.tick, RADIUS_M, KNOT_NODES
        sway = 0.02 * math.sin(self.tick * 2e-3)
        thread.p_W_m = [[x + sway * math.sin(5 * z), y, z] for x, y, z in self.shape]
        thread.tension_N = [5.0 * (i / KNOT_NODES) ** 2 for i in range(KNOT_NODES)]
        thread.turn_rad = [0.15 * i for i in range(KNOT_NODES)]
        thread.grasped_node = [40, 80]
        self.lcm.publish("LIGATURE_THREAD", thread.encode())

    def publish_status(self):
        status = status_t()
        status.session, status.protocol_version, status.firmware_version = self.session, 1, "test"
        status.scene_file = f"scenes/{self.scene}"
        status.scene_toml = SCENE + "\n# as run:" + "".join(f"\n# --set {each}" for each in self.overrides)
        status.period_s, status.max_force_N, status.tick = 1e-3, 3.3, self.tick
        status.state, status.fault, status.realtime, status.armed = self.state, self.fault, 1, int(self.armed)
        self.lcm.publish("LIGATURE_STATUS", status.encode())


SHAPES = {"knot": trefoil, "unknot": unknot, "square": square}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--lcm-url", default="udpm://239.255.76.67:7667?ttl=0")
    rig = Rig(parser.parse_args().lcm_url)
    print("ready", flush=True)
    began = time.monotonic()
    sent, round_number = 0, 0
    while True:
        ready, _, _ = select.select([sys.stdin, rig.lcm.fileno()], [], [], 0.02)
        if rig.lcm.fileno() in ready:
            rig.lcm.handle()
        if sys.stdin in ready:
            # os.read, because readline() could buffer a second line, which select() would then not report.
            heard = os.read(sys.stdin.fileno(), 4096).decode()
            if not heard:
                return
            for line in heard.splitlines():
                rig.obey(line)
        due = min(int((time.monotonic() - began) * 1000) - sent, 40)
        if due < 15:
            continue
        sent = int((time.monotonic() - began) * 1000)
        if rig.quiet:
            continue
        rig.publish(due)
        rig.publish_hands()
        if round_number % 5 == 0:
            rig.publish_status()
        if round_number % 50 == 0:
            rig.publish_offer()
        round_number += 1


if __name__ == "__main__":
    main()
