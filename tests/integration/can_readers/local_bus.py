"""A python-can bus over the rig's `local:` socket, so that python-canopen can control a simulated hand."""

import select
import socket
import struct

import can

IMAGE = struct.Struct("=IB3x8s")  # layout of Linux' struct can_frame


class LocalBus(can.BusABC):
    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._socket.connect(str(path))
        self.channel_info = f"local:{path}"
        super().__init__(channel=str(path))

    def send(self, msg, timeout=None):
        self._socket.send(IMAGE.pack(msg.arbitration_id, msg.dlc, bytes(msg.data).ljust(8, b"\0")))

    def _recv_internal(self, timeout):
        if not select.select([self._socket], [], [], timeout)[0]:
            return None, False
        packet = self._socket.recv(IMAGE.size)
        if len(packet) != IMAGE.size:
            raise can.CanOperationError("the device closed the bus")
        identifier, length, data = IMAGE.unpack(packet)
        return can.Message(arbitration_id=identifier, data=data[:length], is_extended_id=False), False

    def fileno(self):
        return self._socket.fileno()

    def shutdown(self):
        super().shutdown()
        self._socket.close()
