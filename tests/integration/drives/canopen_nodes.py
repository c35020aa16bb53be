"""Three servo drives of python-canopen that serve a maker's dictionary strictly: a table of objects with types, access,
limits and what may be mapped. SDO, NMT, heartbeat and EMCY are python-canopen's own. The PDOs are packed here from the
mapping that the controller wrote, because python-canopen is too slow for 1000 SYNCs a second."""

import csv
import struct

import canopen
from canopen.objectdictionary import ODRecord, ODVariable, ObjectDictionary, datatypes
from canopen.sdo import SdoAbortedError

import servo

NODES = (1, 2, 3)
CONTROLLER = 127
FORMATS = {"UNSIGNED8": "B", "INTEGER8": "b", "UNSIGNED16": "H", "INTEGER16": "h", "UNSIGNED32": "I", "INTEGER32": "i"}
CANNOT_BE_MAPPED, TOO_LONG, TOO_HIGH, WRONG_STATE = 0x06040041, 0x06040042, 0x06090031, 0x08000022
OFF = 0x80000000
MODE_STAYS = (0x6061, 0)


def number(text):
    return int(text, 0) if text else None


class Table:
    """The maker's objects, from a file of the tests' fixtures."""

    def __init__(self, path, changes=()):
        """@param changes (index, sub): None to take an object away, or its new default."""
        with open(path) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.rows = {(int(r["index"], 16), int(r["sub"])): r for r in rows if r["type"] in FORMATS}
        for at, default in dict(changes).items():
            if default is None:
                del self.rows[at]
            else:
                self.rows[at]["default"] = str(default)

    def dictionary(self):
        od = ObjectDictionary()
        has_subs = {index for index, sub in self.rows if sub > 0}
        for (index, sub), row in self.rows.items():
            variable = ODVariable(f"{index:04X}:{sub:02X}", index, sub)
            variable.data_type = getattr(datatypes, row["type"])
            variable.access_type = {"rww": "rw", "rwr": "rw"}.get(row["access"], row["access"])
            variable.default = number(row["default"]) or 0
            if index not in has_subs:
                od.add_object(variable)
                continue
            if index not in od:
                od.add_object(ODRecord(f"{index:04X}", index))
            od[index].add_member(variable)
        return od

    def refusal(self, node, at, value):
        """The abort code with which the drive refuses a write, or None."""
        index, sub = at
        row = self.rows[at]
        low, high = number(row["min"]), number(row["max"])
        if (low is not None and value < low) or (high is not None and value > high):
            return TOO_HIGH
        kind = index & 0xFE00
        if kind in (0x1600, 0x1A00):
            if not node.value(index - 0x200, 1) & OFF:
                return WRONG_STATE  # a mapping may be changed only while its PDO is off
            if sub == 0:
                bits = sum(node.value(index, i) & 0xFF for i in range(1, value + 1))
                return TOO_LONG if bits > 64 else None
            return self.mapping_refusal(value)
        return None

    def mapping_refusal(self, word):
        mapped = self.rows.get((word >> 16, word >> 8 & 0xFF))
        if mapped is None or mapped["pdo_mappable"] != "1":
            return CANNOT_BE_MAPPED
        return None if word & 0xFF == 8 * struct.calcsize(FORMATS[mapped["type"]]) else CANNOT_BE_MAPPED


class Node(canopen.LocalNode):
    def __init__(self, table, number):
        super().__init__(number, table.dictionary())
        self.table, self.servo, self.inputs, self.counts = table, servo.Servo(), 0, 0
        self.writes, self.received, self.stays_in_mode = [], None, 0
        self.maps = {}
        for base, pdo in ((0x1400, 0x200), (0x1800, 0x180)):
            for i in range(4):
                if (base + i, 1) in table.rows:
                    self.data_store.setdefault(base + i, {})[1] = struct.pack("<I", pdo + 0x100 * i + number)

    def get_data(self, index, subindex, check_readable=False):
        if (index, subindex) == (0x6041, 0):
            return struct.pack("<H", self.servo.statusword)
        if (index, subindex) == (0x6061, 0):  # the mode in force; a drive may be made to stay in another one
            return bytes([self.stays_in_mode]) if self.stays_in_mode else super().get_data(0x6060, 0)
        return super().get_data(index, subindex, check_readable)

    def value(self, index, sub):
        return int.from_bytes(self.get_data(index, sub), "little")

    def set_data(self, index, subindex, data, check_writable=False):
        obj = self._find_object(index, subindex)
        if check_writable and not obj.writable:
            raise SdoAbortedError(0x06010002)
        if len(data) * 8 != len(obj):
            raise SdoAbortedError(0x06070010)
        format = FORMATS[self.table.rows[index, obj.subindex]["type"]]
        code = self.table.refusal(self, (index, obj.subindex), struct.unpack("<" + format, bytes(data))[0])
        if code is not None:
            raise SdoAbortedError(code)
        self.writes.append((index, subindex))
        super().set_data(index, subindex, data, check_writable)
        if (index, subindex) == (0x1016, 1):
            word = int.from_bytes(data, "little")
            self.servo.watch_s = (word & 0xFFFF) * 1e-3 if word >> 16 & 0x7F == CONTROLLER else 0.0
            self.servo.heard = None

    def learn_maps(self):
        """Reads the mapping of the PDOs that are on, as written by the controller."""
        self.maps = {}
        for base in (0x1400, 0x1800):
            for i in range(4):
                if (base + i, 1) not in self.table.rows or self.value(base + i, 1) & OFF:
                    continue
                words = [self.value(base + 0x200 + i, s) for s in range(1, self.value(base + 0x200 + i, 0) + 1)]
                objects = [(w >> 16, w >> 8 & 0xFF) for w in words]
                formats = "".join(FORMATS[self.table.rows[o]["type"]] for o in objects)
                self.maps[self.value(base + i, 1) & 0x7FF] = (base == 0x1800, struct.Struct("<" + formats), objects)

    def samples(self):
        """The TPDOs of one SYNC: (identifier, data)."""
        now = {(0x6041, 0): self.servo.statusword, (0x6064, 0): self.counts, (0x6077, 0): self.servo.torque, (0x3141, 1): self.inputs,
               (0x60FD, 0): self.inputs}
        return [(cob, form.pack(*(now.get(o, 0) for o in objects))) for cob, (out, form, objects) in self.maps.items() if out]

    def on_rpdo(self, cob, data):
        out, form, objects = self.maps.get(cob, (True, None, None))
        if not out and len(data) == form.size:
            self.received = dict(zip(objects, form.unpack(data), strict=True))

    def act(self):
        """At a SYNC, after the sample: the last RPDO takes effect."""
        if self.received is None:
            return
        mode = self.value(0x6060, 0)
        self.servo.command(self.received[0x6040, 0], self.received[0x6071, 0] if mode == 10 else 0)
        self.received = None


class Bus:
    """What python-canopen needs to send frames."""

    def __init__(self, server):
        self.server = server

    def send(self, msg, timeout=None):
        self.server.send(msg.arbitration_id, msg.data)

    def send_periodic(self, msg, period, *_, **__):
        return Periodic(self, msg, period)


class Periodic:
    """A heartbeat, sent when the hand's loop asks for it."""

    all = []

    def __init__(self, bus, msg, period):
        self.bus, self.msg, self.period, self.next = bus, msg, period, 0.0
        Periodic.all.append(self)

    def modify_data(self, msg):
        self.msg = msg

    def stop(self):
        if self in Periodic.all:
            Periodic.all.remove(self)


class Nodes:
    """The three drives behind the interface that hand.py needs."""

    def __init__(self, server, table, changes=()):
        self.server = server
        self.network = canopen.Network()
        self.network.bus = Bus(server)
        mode = dict(changes).get(MODE_STAYS, 0)
        table = Table(table, {at: value for at, value in dict(changes).items() if at != MODE_STAYS})
        self.nodes = [Node(table, n) for n in NODES]
        for node in self.nodes:
            node.stays_in_mode = mode
        for node in self.nodes:
            self.network.add_node(node)
            node.nmt.state = "PRE-OPERATIONAL"
        self.operational = False

    @property
    def servos(self):
        return [n.servo for n in self.nodes]

    def place(self, counts, inputs):
        for node, c in zip(self.nodes, counts, strict=True):
            node.counts, node.inputs = c, inputs if node.id == 3 else 0

    def on_sync(self):
        if not self.operational:
            return
        for node in self.nodes:
            for cob, data in node.samples():
                self.server.send(cob, data)
            node.act()

    def on_frame(self, identifier, data, now):
        if 0x200 < identifier <= 0x57F and identifier & 0x80 == 0:
            for node in self.nodes if self.operational else ():
                node.on_rpdo(identifier, data)
        elif identifier == 0 and any(s.is_deaf for s in self.servos):
            pass  # the drives go on
        elif identifier == 0x700 + CONTROLLER:
            for node in self.nodes:
                node.servo.heartbeat()
        else:
            self.network.notify(identifier, bytearray(data), now)
            if identifier == 0:
                self.on_nmt()

    def on_nmt(self):
        self.operational = all(n.nmt.state == "OPERATIONAL" for n in self.nodes)
        for node in self.nodes:
            node.learn_maps() if self.operational else node.servo.leave_operational()

    def poll(self, now):
        for node in self.nodes:
            if node.servo.misses_heartbeat():
                node.emcy.send(servo.HEARTBEAT_LOST, register=0x11)
        for beat in Periodic.all:
            if now >= beat.next:
                beat.next = now + beat.period
                beat.bus.send(beat.msg)

    def fail(self, node):
        self.nodes[node - 1].servo.trip(0x2310)
        self.nodes[node - 1].emcy.send(0x2310, register=0x03)

    def run_away(self, node):
        self.nodes[node - 1].servo.run_away(300)

    def clear(self):
        for servo_ in self.servos:
            servo_.__init__()
