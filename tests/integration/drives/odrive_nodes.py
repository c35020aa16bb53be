"""Three ODrive drives and a button module that answers the request to drive 3, as the DBC of PyPI's odrive-can describes the frames. Every kind of frame is
read and made by cantools, at first and then now and again; in between by a struct that was found to give the same, because
cantools is too slow for 1000 requests a second."""

import importlib.util
import pathlib
import struct
import time

import cantools

REMOTE = 0x40000000
VERSION, HEARTBEAT, ESTOP, STATE, ESTIMATES, MODE, POSITION, VELOCITY, TORQUE, LIMITS, CLEAR, TORQUES = 0x00, 0x01, 0x02, 0x07, 0x09, 0x0B, 0x0C, 0x0D, 0x0E, 0x0F, 0x18, 0x1C
IDLE, CLOSED_LOOP = 1, 8
WATCHDOG_EXPIRED, ESTOP_REQUESTED, DRV_FAULT = 0x01000000, 0x02000000, 0x20
BUTTONS_ID = 0x201
COUNTS_PER_REV = 16384
PERMILLE = 0.3e-3  # N m
PER_S, NM_S_PER_REV = 20.0, 0.167  # gains of the control of position and velocity, as delivered
STORED_MODE = (3, 1)  # position control, as delivered
CHECKED, THEN_EVERY = 200, 100
WATCHDOG = (0, 0)  # --change 0:0=MS: the time to which the drives' watchdog is set; 0 is off
TAKES_NO_SHORT_TORQUE = (0, 1)  # --change 0:1=1: the drives want torque messages of 8 bytes
FED_BY_ALL = (0, 2)  # --change 0:2=1: every frame feeds the watchdog, as in software before 0.6; else torques do
KEEPS_MODE = (0, 4)  # --change 0:4=1: the drives stay in their stored mode
BUTTONS_ASLEEP = (0, 3)  # --change 0:3=1: the button module repeats its first frame


def dbc():
    folder = pathlib.Path(importlib.util.find_spec("odrive_can").submodule_search_locations[0])
    return cantools.database.load_file(folder / "dbc/odrive-cansimple-0.6.10.dbc")


class Codec:
    STRUCTS = {ESTIMATES: struct.Struct("<ff"), TORQUES: struct.Struct("<ff"), VERSION: struct.Struct("<8B"), TORQUE: struct.Struct("<f"), HEARTBEAT: struct.Struct("<IBBBx")}
    NAMES = {VERSION: "Get_Version", TORQUES: "Get_Torques", LIMITS: "Set_Limits", HEARTBEAT: "Heartbeat", ESTOP: "Estop", STATE: "Set_Axis_State", ESTIMATES: "Get_Encoder_Estimates", MODE: "Set_Controller_Mode",
             POSITION: "Set_Input_Pos", VELOCITY: "Set_Input_Vel", TORQUE: "Set_Input_Torque", CLEAR: "Clear_Errors"}

    def __init__(self):
        self.messages = {m.frame_id: m for m in dbc().messages if m.name.startswith("Axis0_")}
        self.used = {}
        for command, name in self.NAMES.items():
            assert self.messages[command].name == "Axis0_" + name

    def is_checked(self, command):
        self.used[command] = self.used.get(command, 0) + 1
        return command not in self.STRUCTS or self.used[command] < CHECKED or self.used[command] % THEN_EVERY == 0

    def make(self, command, *values):
        data = self.STRUCTS[command].pack(*values)
        if self.is_checked(command):
            message = self.messages[command]
            assert bytes(message.encode(dict(zip([s.name for s in message.signals], values)), strict=False)) == data
        return data

    def read(self, command, data):
        """The values of a frame of the controller, in the DBC's order. Bytes that a short frame lacks are zero."""
        if self.is_checked(command):
            message = self.messages[command]
            whole = bytes(data).ljust(message.length, b"\0")
            assert len(data) == message.length or command == TORQUE and len(data) == 4, (message.name, data)
            values = tuple(message.decode(whole, decode_choices=False).values())
            assert command != TORQUE or values == self.STRUCTS[TORQUE].unpack(data[:4])
            return values
        return self.STRUCTS[command].unpack(data[:4])


class Drive:
    """Has what hand.py looks at: `state` as of CiA 402 (0x27 on, 0x40 off), and the torque in per mille of the rated one."""

    def __init__(self, node, watchdog_s, wants_long, keeps_mode):
        self.node, self.watchdog_s, self.wants_long, self.keeps_mode = node, watchdog_s, wants_long, keeps_mode
        self.axis, self.error, self.mode, self.input_Nm, self.fed, self.limits = IDLE, 0, STORED_MODE, 0.0, None, None
        self.input_rev, self.input_rev_per_s = 0.0, 0.0
        self.beat_at, self.counts = 0.0, 0

    @property
    def state(self):
        return 0x27 if self.axis == CLOSED_LOOP else 0x40

    @property
    def torque_Nm(self):
        if self.axis != CLOSED_LOOP:
            return 0.0
        aside = self.input_rev_per_s + (PER_S * (self.input_rev - self.counts / COUNTS_PER_REV) if self.mode[0] == 3 else 0.0)
        return self.input_Nm + (0.0 if self.mode == (1, 1) else NM_S_PER_REV * aside)

    @property
    def torque(self):
        return round(self.torque_Nm / PERMILLE)

    def disarm(self, error=0):
        self.axis, self.input_Nm, self.fed, self.error = IDLE, 0.0, None, self.error | error

    def obey(self, command, data, codec, now):
        if command == TORQUE and self.wants_long and len(data) != 8:
            return
        values = codec.read(command, data)
        if command == TORQUE:
            self.fed = now
            self.input_Nm = values[0] if self.axis == CLOSED_LOOP else 0.0
        elif command == STATE and values[0] == IDLE:
            self.disarm()
        elif command == STATE and values[0] == CLOSED_LOOP and not self.error:
            assert self.limits is not None, "the controller sets the limits first"
            self.axis, self.fed, self.input_rev, self.input_rev_per_s = CLOSED_LOOP, now, self.counts / COUNTS_PER_REV, 0.0
        elif command == MODE and not self.keeps_mode:
            self.mode = values
        elif command == POSITION:
            self.input_rev, self.input_Nm = values[0], values[2]
        elif command == VELOCITY:
            self.input_rev_per_s, self.input_Nm = values
        elif command == LIMITS:
            self.limits = values
        elif command == CLEAR:
            self.error = 0
        elif command == ESTOP:
            self.disarm(ESTOP_REQUESTED)

    def watch(self, now):
        if self.axis == CLOSED_LOOP and self.watchdog_s and self.fed is not None and now > self.fed + self.watchdog_s:
            self.disarm(WATCHDOG_EXPIRED)


class Nodes:
    """The three drives behind the interface that hand.py needs."""

    REQUEST = REMOTE | 1 << 5 | ESTIMATES

    def __init__(self, server, _table=None, changes=()):
        self.server, self.codec = server, Codec()
        changes = dict(changes)
        self.fed_by_all, self.asleep = FED_BY_ALL in changes, BUTTONS_ASLEEP in changes
        self.make = lambda: [Drive(n, changes.get(WATCHDOG, 1000) * 1e-3, TAKES_NO_SHORT_TORQUE in changes, KEEPS_MODE in changes) for n in (1, 2, 3)]
        self.servos = self.make()
        self.inputs, self.life = 0, 0

    def place(self, counts, inputs):
        for drive, c in zip(self.servos, counts, strict=True):
            drive.counts = c
        self.inputs = inputs

    def on_sync(self):
        self.on_frame(self.REQUEST, b"", time.monotonic())

    def answer(self, drive):
        position = struct.unpack("<f", struct.pack("<f", drive.counts / COUNTS_PER_REV))[0]
        self.server.send(drive.node << 5 | ESTIMATES, self.codec.make(ESTIMATES, position, 0.0))
        if drive is self.servos[-1]:
            self.life = (self.life + (not self.asleep)) % 256
            self.server.send(BUTTONS_ID, struct.pack("<H", self.inputs | self.life << 8))

    def answer_more(self, drive, command):
        """What start-up asks for."""
        assert command in (VERSION, TORQUES), command
        values = (2, 4, 4, 58, 0, 6, 10, 0) if command == VERSION else (drive.torque_Nm, drive.torque_Nm)
        self.server.send(drive.node << 5 | command, self.codec.make(command, *values))

    def on_frame(self, identifier, data, now):
        node, command = (identifier & 0x7FF) >> 5, identifier & 0x1F
        if not 1 <= node <= 3:
            return
        drive = self.servos[node - 1]
        drive.watch(now)  # a watchdog that ran out before this frame acts first
        if self.fed_by_all:
            drive.fed = now
        if not identifier & REMOTE:
            return drive.obey(command, data, self.codec, now)
        self.answer(drive) if command == ESTIMATES else self.answer_more(drive, command)

    def poll(self, now):
        for drive in self.servos:
            drive.watch(now)
            if now >= drive.beat_at:
                drive.beat_at = now + 0.020
                self.server.send(drive.node << 5 | HEARTBEAT, self.codec.make(HEARTBEAT, drive.error, drive.axis, 0, 0))

    def fail(self, node):
        self.servos[node - 1].disarm(DRV_FAULT)

    def clear(self):
        self.servos = self.make()
