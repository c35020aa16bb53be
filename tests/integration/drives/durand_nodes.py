"""Three servo drives of durand, a CANopen stack that shares no code with ours or python-canopen. Its nodes know neither an
RPDO timer nor the consumer's heartbeat: a drive without a watchdog. SDO, NMT, PDOs with their mapping, heartbeat and EMCY
are durand's own."""

from durand import MinimalNode, Record, Variable, set_scheduler
from durand.datatypes import DatatypeEnum as Type
from durand.network import NetworkABC
from durand.scheduler import VirtualScheduler
from durand.services.nmt import StateEnum

import servo

NODES = (1, 2, 3)
OBJECTS = (  # index, type, access, value
    (0x6007, Type.INTEGER16, "rw", 0), (0x6040, Type.UNSIGNED16, "rw", 0), (0x6041, Type.UNSIGNED16, "ro", 0),
    (0x6060, Type.INTEGER8, "rw", 0), (0x6061, Type.INTEGER8, "ro", 0), (0x6064, Type.INTEGER32, "ro", 0), (0x6071, Type.INTEGER16, "rw", 0),
    (0x6072, Type.UNSIGNED16, "rw", 3000), (0x6076, Type.UNSIGNED32, "ro", 300), (0x6077, Type.INTEGER16, "ro", 0),
    (0x60FD, Type.UNSIGNED32, "ro", 0))


class Network(NetworkABC):
    """Hands frames from and to the `local:` bus; several nodes may subscribe to one identifier."""

    def __init__(self, server):
        self.server, self.callbacks, self.owner = server, {}, None

    def add_subscription(self, cob_id, callback):
        self.callbacks.setdefault(cob_id, {})[self.owner] = callback

    def remove_subscription(self, cob_id, callback=None):
        self.callbacks.get(cob_id, {}).pop(self.owner, None)

    def send(self, cob_id, msg):
        self.server.send(cob_id, msg)

    def deliver(self, identifier, data):
        for owner, callback in list(self.callbacks.get(identifier, {}).items()):
            self.owner = owner  # a reaction may subscribe or leave
            callback(identifier, data)


class Nodes:
    """The three drives behind the interface that hand.py needs."""

    def __init__(self, server, _table=None, changes=()):
        self.scheduler = VirtualScheduler()
        set_scheduler(self.scheduler)
        self.network, self.nodes, self.servos, self.now = Network(server), [], [], None
        for number in NODES:
            self.network.owner = number
            node = MinimalNode(self.network, number)
            self.fill(node.object_dictionary, dict(changes))
            od = node.object_dictionary
            od.set_read_callback(0x6061, 0, lambda od=od: od.read(0x6060, 0))
            self.nodes.append(node)
            self.servos.append(servo.Servo())
            node.nmt.state_callbacks.add(lambda state, s=self.servos[-1]: self.on_nmt(s, state))

    @staticmethod
    def fill(od, changes):
        for index, kind, access, value in OBJECTS:
            value = changes.get((index, 0), value)
            if value is not None:
                od[index] = Variable(kind, access, value)
        for index, subs in ((0x608F, ((1, Type.UNSIGNED32, "const", 16384), (2, Type.UNSIGNED32, "const", 1))),
                            (0x60C2, ((1, Type.UNSIGNED8, "rw", 0), (2, Type.INTEGER8, "rw", -3)))):
            record = Record()
            for sub, kind, access, value in subs:
                record[sub] = Variable(kind, access, changes.get((index, sub), value))
            od[index] = record

    @staticmethod
    def on_nmt(drive, state):
        if state != StateEnum.OPERATIONAL:
            drive.leave_operational()

    @property
    def operational(self):
        return all(n.nmt.state == StateEnum.OPERATIONAL for n in self.nodes)

    def place(self, counts, inputs):
        for number, node, drive, c in zip(NODES, self.nodes, self.servos, counts, strict=True):
            od = node.object_dictionary
            od.write(0x6064, 0, c)
            od.write(0x6041, 0, drive.statusword)
            od.write(0x6077, 0, drive.torque)
            od.write(0x60FD, 0, inputs if number == 3 else 0)

    def on_sync(self):
        self.network.deliver(0x080, b"")  # TPDOs are sent, then the RPDOs of before are written into the dictionary
        if not self.operational:
            return
        for node, drive in zip(self.nodes, self.servos, strict=True):
            od = node.object_dictionary
            drive.command(od.read(0x6040, 0), od.read(0x6071, 0) if od.read(0x6060, 0) == 10 else 0)

    def on_frame(self, identifier, data, _now):
        self.network.deliver(identifier, data)

    def poll(self, now):
        if self.now is not None:
            self.scheduler.run(now - self.now)
        self.now = now

    def fail(self, node):
        self.servos[node - 1].trip(0x2310)
        self.nodes[node - 1].emcy.set(0x2310, 0)

    def clear(self):
        for drive in self.servos:
            drive.__init__()
