"""A `local:` bus that this process serves to one controller after the other."""

import os
import select
import socket
import struct

IMAGE = struct.Struct("=IB3x8s")  # layout of Linux' struct can_frame
FD_IMAGE = struct.Struct("=IBB2x64s")  # and of its struct canfd_frame
SWITCHES_RATE = 1


class LocalServer:
    def __init__(self, path):
        self.listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.listener.bind(path)
        self.listener.listen(1)
        self.path, self.controller = path, None
        self.data, self.is_fast_fd = b"", False  # of the last frame

    def close(self):
        os.unlink(self.path)

    def send(self, identifier, data):
        self.put(IMAGE.pack(identifier, len(data), bytes(data).ljust(8, b"\0")))

    def send_fd(self, identifier, data):
        self.put(FD_IMAGE.pack(identifier, len(data), SWITCHES_RATE, bytes(data).ljust(64, b"\0")))

    def put(self, packet):
        if self.controller is None:
            return
        try:
            self.controller.send(packet)
        except OSError:
            pass  # the controller is gone: nobody hears this frame

    def receive(self, timeout_s, *others):
        """Waits for a frame of the controller. @param others further descriptors whose data ends the wait.
        @return (identifier, data), or None if there is no frame."""
        source = self.controller or self.listener
        ready = select.select([source, *others], [], [], timeout_s)[0]
        if source not in ready:
            return None
        if self.controller is None:
            self.controller = self.listener.accept()[0]
            return None
        try:
            packet = self.controller.recv(FD_IMAGE.size)
        except OSError:
            packet = b""
        if not packet:  # the controller is dead; a real bus would just be silent
            self.controller.close()
            self.controller = None
            return None
        is_fd = len(packet) == FD_IMAGE.size
        identifier, length, *flags, data = (FD_IMAGE if is_fd else IMAGE).unpack(packet)
        self.data, self.is_fast_fd = data[:length], flags == [SWITCHES_RATE]
        return identifier, self.data
