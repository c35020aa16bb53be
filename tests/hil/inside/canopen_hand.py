"""Three CiA 402 drives implemented with python-canopen, controlled by ligature-firmware on vcan0. SDO, NMT, PDO,
heartbeat and EMCY are python-canopen's own; what was received is written to /run/canopen.json. SYNC and RPDO, 4000
frames per second, bypass its dispatcher, which is too slow on the emulated CPU; their mapping is read by canopen from
the objects that the firmware has written."""

import json
import socket
import struct
import threading
import time

import can
import canopen

NODES = (1, 2, 3)
ELBOW = 3
GRIP_AND_DEAD_MAN = 3
SHUTDOWN, SWITCH_ON, ENABLE, FAULT_RESET, DISABLE = 0x06, 0x07, 0x0F, 0x80, 0x00
NOT_READY, DISABLED, READY, SWITCHED_ON, ENABLED, FAULT = 0x00, 0x40, 0x21, 0x23, 0x27, 0x08
START = {1: -431, 2: 1664, 3: 892}  # counts, at the start pose of the overhand script: (0, 0, 2.3) in the world
STILL = 900  # number of SYNCs at rest, during which the gain rises
IMAGE = struct.Struct("=IB3x8s")  # layout of Linux' struct can_frame
RUN_S, AFTER_S, BOUND_S = 2.0, 0.3, 20.0


class Drive:
    def __init__(self, network, node):
        self.id = node
        self.local = canopen.LocalNode(node, canopen.import_od(f"/run/node-{node}.eds", node))
        network.add_node(self.local)
        self.state, self.counts = DISABLED, START[node]
        self.rpdos, self.torques, self.written, self.states = 0, [], [], []
        self.local.add_write_callback(self.on_write)

    def on_write(self, index, subindex, od, data):
        self.written.append([index, subindex, int.from_bytes(data, "little")])
        self.states.append(self.local.nmt.state)

    def on_rpdo(self, data):
        """Decodes an RPDO as mapped by the firmware: controlword, target torque."""
        word, torque = struct.unpack("<Hh", data)
        self.rpdos += 1
        self.torques.append(torque)
        step = {SHUTDOWN: READY, SWITCH_ON: SWITCHED_ON, ENABLE: ENABLED, DISABLE: DISABLED}.get(word & 0x8F)
        if self.state != FAULT and step is not None:
            self.state = step
        elif self.state == FAULT and word & FAULT_RESET:
            self.state = DISABLED

    def image(self):
        last = GRIP_AND_DEAD_MAN if self.id == ELBOW else 0
        return struct.pack("<HiH", self.state | 0x210, self.counts, last)


class Hand:
    def __init__(self):
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind(("vcan0",))
        nothing = [{"can_id": 0x7FF, "can_mask": 0x7FF}]
        # canopen uses this bus only to send (the filter lets nothing in); all frames are received through self.socket.
        self.network = canopen.Network(can.Bus("vcan0", interface="socketcan", can_filters=nothing))
        self.drives = [Drive(self.network, n) for n in NODES]
        self.syncs, self.heartbeats, self.maps = 0, 0, {}
        self.network.subscribe(0x77F, self.on_heartbeat)
        self.rpdo_of = {0x200 + d.id: d for d in self.drives}

    def connect(self):
        threading.Thread(target=self.receive, daemon=True).start()
        for drive in self.drives:
            drive.local.nmt.state = "PRE-OPERATIONAL"

    def receive(self):
        while True:
            identifier, length, data = IMAGE.unpack(self.socket.recv(16))
            if identifier == 0x080:
                self.on_sync()
            elif identifier in self.rpdo_of:
                self.rpdo_of[identifier].on_rpdo(data[:length])
            else:
                self.network.notify(identifier, bytearray(data[:length]), time.monotonic())

    def on_heartbeat(self, *_):
        self.heartbeats += 1

    def on_sync(self):
        self.syncs += 1
        for drive in self.drives:
            if drive.local.nmt.state != "OPERATIONAL":
                continue
            if drive.id not in self.maps:  # the mapping written by SDO, as canopen decodes it
                drive.local.tpdo[1].read(from_od=True)
                tpdo = drive.local.tpdo[1]
                self.maps[drive.id] = {"cob_id": tpdo.cob_id, "type": tpdo.trans_type, "map": [[v.index, v.subindex, v.length] for v in tpdo.map]}
            if drive.id == 1:
                # The waist turns, so the thread pulls on the hand.
                drive.counts = START[1] + max(0, min((self.syncs - STILL) // 4, 200))
            self.socket.send(IMAGE.pack(0x180 + drive.id, 8, drive.image()))

    def report(self, emergency_at):
        drives = [{"node": d.id, "nmt": d.local.nmt.state, "state": d.state, "rpdos": d.rpdos, "written": d.written, "map": self.maps.get(d.id),
                   "nmt_while_written": sorted(set(d.states)),
                   "torque_before": max(map(abs, d.torques[:at]), default=0), "torque_at_end": d.torques[-1] if d.torques else None}
                  for d, at in zip(self.drives, emergency_at, strict=True)]
        return {"syncs": self.syncs, "heartbeats": self.heartbeats, "drives": drives}


def main():
    hand = Hand()
    hand.connect()
    print("ready", flush=True)
    until = time.monotonic() + BOUND_S
    while hand.syncs == 0 or not all(d.state == ENABLED for d in hand.drives):
        if time.monotonic() > until:
            raise SystemExit(f"not enabled: {hand.report([0, 0, 0])}")
        time.sleep(0.05)
    print("enabled", flush=True)
    time.sleep(RUN_S)
    at = [len(d.torques) for d in hand.drives]
    hand.drives[1].local.emcy.send(0x2310, register=0x03)
    time.sleep(AFTER_S)
    with open("/run/canopen.json", "w") as out:
        json.dump(hand.report(at), out)
    print(f"syncs {hand.syncs}, heartbeats {hand.heartbeats}", flush=True)


main()
