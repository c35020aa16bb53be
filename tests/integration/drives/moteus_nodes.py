"""Three moteus drives and a button module that answers the query to drive 3. The maker's Python package makes every kind of
frame that the controller sends, and the bytes must be the same; it also reads what the drives answer. At first for every frame,
then now and again, because it is too slow for 6000 frames a second."""

import math
import struct
import time

import moteus
from moteus import multiplex as mp, protocol

EXTENDED, WANTS_REPLY, BUTTONS_ID = 0x80000000, 0x8000, 0x400
STOPPED, FAULT, ENABLING, POSITION, TIMEOUT = 0, 1, 2, 10, 11
LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)
COUNTS_PER_REV = 16384
PERMILLE = 0.3e-3  # N m
PREPARES_S = 0.005
DAMPING_NM = 0.06  # of a drive whose watchdog ran out, while the person goes on moving it
CHECKED, THEN_EVERY = 300, 100
NO_WATCHDOG = (0, 0)     # --change 0:0=1: the drives do not look at it
BUTTONS_ASLEEP = (0, 1)  # --change 0:1=1: the button module repeats its first frame
KEEPS_GAINS = (0, 2)     # --change 0:2=1: the drives keep their stored gains
STORED_MODE = (0, 3)     # --change 0:3=6: drive 3 is in this mode after power-on, and obeys no stop


class Positions(moteus.PositionResolution):
    position = kp_scale = kd_scale = ilimit_scale = mp.INT8


def padded(data):
    length = next(n for n in LENGTHS if n >= len(data))
    return bytes(data) + b"\x50" * (length - len(data))


def query_of(register):
    wanted = moteus.QueryResolution()
    wanted.velocity = wanted.voltage = wanted.temperature = mp.IGNORE
    wanted._extra = {register: mp.F32}
    return wanted


class Codec:
    def __init__(self):
        self.used, self.makers = {}, {n: moteus.Controller(id=n, transport=object(), position_resolution=Positions()) for n in (1, 2, 3)}

    def is_checked(self, kind):
        self.used[kind] = self.used.get(kind, 0) + 1
        return self.used[kind] < CHECKED or self.used[kind] % THEN_EVERY == 0

    @staticmethod
    def same(command, identifier, data):
        number = command.source << 8 | command.destination | (WANTS_REPLY if command.reply_required else 0)
        assert identifier == (number | EXTENDED if number > 0x7FF else number), hex(identifier)
        assert padded(command.data) == data, (padded(command.data).hex(), data.hex())

    def check(self, identifier, data):
        node = identifier & 0x7F
        maker = self.makers[node]
        if identifier & WANTS_REPLY:
            if self.is_checked(("query", data[9])):
                self.same(maker.make_query(query_override=query_of(data[9])), identifier, data)
        elif len(data) == 3:
            if self.is_checked("stop"):
                self.same(maker.make_stop(), identifier, data)
        elif self.is_checked("torque"):
            said = protocol.parse_registers(data).command
            wanted = {k: said[r] for k, r in (("feedforward_torque", 0x22), ("maximum_torque", 0x25), ("watchdog_timeout", 0x27))}
            self.same(maker.make_position(position=math.nan, kp_scale=0.0, kd_scale=0.0, ilimit_scale=0.0, **wanted), identifier, data)

    def reply(self, drive, register, value):
        f32 = struct.Struct("<f").pack
        data = (bytes((0x21, 0, drive.mode, 0x2D, 1)) + f32(drive.counts / COUNTS_PER_REV) + bytes((0x2D, 3)) + f32(drive.torque_Nm) +
                bytes((0x21, 0x0F, drive.fault, 0x2D, register)) + f32(value))
        if self.is_checked("reply"):
            told = protocol.parse_reply(data)
            assert told[protocol.Register.MODE] == drive.mode and told[protocol.Register.FAULT] == drive.fault
            assert f32(told[protocol.Register.POSITION]) == data[5:9] and f32(told[protocol.Register.TORQUE]) == data[11:15]
            assert f32(told[register]) == data[20:24]
        return data


class Drive:
    """Has what hand.py looks at: `state` as of CiA 402 (0x27 on, 0x40 off), and the torque in per mille of the rated one."""

    def __init__(self, node, changes):
        self.node, self.changes, self.mode, self.fault, self.counts = node, changes, changes.get(STORED_MODE, 0) if node == 3 else 0, 0, 0
        self.command, self.fed, self.ready = dict.fromkeys((0x23, 0x24, 0x2B), 1.0), None, None

    @property
    def state(self):
        return 0x27 if self.mode == POSITION else 0x40

    @property
    def torque_Nm(self):
        return self.command.get(0x22, 0.0) if self.mode == POSITION else -DAMPING_NM if self.mode == TIMEOUT else 0.0

    @property
    def torque(self):
        return round(self.torque_Nm / PERMILLE)

    def value(self, register):
        return 1.0 if register == 0x0C else self.command.get(register, math.nan)

    def obey(self, data, now):
        mode = data[2]
        self.command = dict.fromkeys((0x23, 0x24, 0x2B), 1.0)  # a mode resets all that was commanded before
        if mode == STOPPED:
            if not (self.node == 3 and STORED_MODE in self.changes):
                self.mode, self.fault, self.fed = STOPPED, 0, None
            return
        assert mode == POSITION and len(data) == 32, data.hex()
        torque, most, watchdog = (struct.unpack_from("<f", data, at)[0] for at in (8, 18, 24))
        self.command |= {0x22: torque, 0x25: most, 0x27: watchdog, 0x24: data[15] / 127, 0x2B: data[30] / 127}
        if KEEPS_GAINS not in self.changes:
            self.command[0x23] = data[14] / 127
        self.fed = now
        if self.mode == STOPPED:
            self.mode, self.ready = ENABLING, now + PREPARES_S

    def watch(self, now):
        if self.mode == ENABLING and now >= self.ready:
            self.mode = POSITION
        silence = now - self.fed if self.fed is not None else 0.0
        if self.mode == POSITION and NO_WATCHDOG not in self.changes and silence > self.command[0x27]:
            self.mode = TIMEOUT
            return silence
        return None


class Nodes:
    """The three drives behind the interface that hand.py needs."""

    REQUEST = EXTENDED | WANTS_REPLY | 1

    def __init__(self, server, _table=None, changes=()):
        self.server, self.codec, self.changes = server, Codec(), dict(changes)
        self.inputs, self.life = 0, None
        self.servos = [Drive(n, self.changes) for n in (1, 2, 3)]

    def clear(self):
        """The drives forget nothing when their controller dies: only its stop ends the mode after the watchdog."""

    def place(self, counts, inputs):
        for drive, c in zip(self.servos, counts, strict=True):
            drive.counts = c
        self.inputs = inputs

    def on_sync(self):
        self.on_frame(self.REQUEST, self.server.data, time.monotonic())

    def on_frame(self, identifier, data, now):
        assert self.server.is_fast_fd, "every frame is an FD frame with bit-rate switch"
        self.codec.check(identifier, data)
        drive = self.servos[(identifier & 0x7F) - 1]
        drive.watch(now)  # a watchdog that ran out before this frame acts first
        if not identifier & WANTS_REPLY:
            return drive.obey(data, now)
        self.server.send_fd(drive.node << 8, self.codec.reply(drive, data[9], drive.value(data[9])))
        if drive is self.servos[-1]:
            if self.life is None or BUTTONS_ASLEEP not in self.changes:
                self.life = data[9]
            self.server.send(BUTTONS_ID, struct.pack("<H", self.inputs | self.life << 8))

    def poll(self, now):
        for drive in self.servos:
            silence = drive.watch(now)
            if silence is not None:
                print("damps", drive.node, round(1000 * silence), flush=True)

    def fail(self, node):
        self.servos[node - 1].mode, self.servos[node - 1].fault = FAULT, 33
