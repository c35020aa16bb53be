"""A simulated Inverse Service of Haply: one state for each message, over WebSocket, with a device that a test moves.

Written from https://docs.haply.co/inverseSDK/service (3.5), apart from the bridge's code. It keeps the newest force and
when it came. `obey()` may be called from any thread."""

import asyncio
import json
import threading
import time

import tornado.httpserver
import tornado.netutil
import tornado.web
import tornado.websocket

KEYS = {"inverse3", "session"}


def complaint_about(message):
    """What is wrong with a client's message; None: nothing."""
    if not isinstance(message, dict) or not set(message) <= KEYS:
        return f"unknown keys: {message}"
    for device in message.get("inverse3", []):
        if set(device) != {"device_id", "commands"} or set(device["commands"]) != {"set_cursor_force"}:
            return f"unknown command: {device}"
        values = device["commands"]["set_cursor_force"].get("vector", {})
        if set(values) != {"x", "y", "z"} or not all(isinstance(v, (int, float)) for v in values.values()):
            return f"no vector: {values}"
    return None


class Socket(tornado.websocket.WebSocketHandler):
    def initialize(self, service):
        self.service, self.messages, self.force = service, 0, None

    def open(self):
        self.set_nodelay(True)
        self.service.clients.add(self)
        if not self.service.silent:
            self.write_message(json.dumps(self.service.everything()))

    def on_message(self, text):
        service = self.service
        message = json.loads(text)
        wrong = complaint_about(message)
        if wrong or (self.messages == 0) != ("session" in message):
            service.complaints.append(wrong or f"session in message {self.messages}")
        self.messages += 1
        time.sleep(service.late_s)  # the whole service is late, also with reading the next message
        for device in [] if wrong else message.get("inverse3", []):
            if device["device_id"] != service.device_id:
                service.complaints.append(f"another device: {device['device_id']}")
                continue
            values = device["commands"]["set_cursor_force"]["vector"]
            service.take_force((values["x"], values["y"], values["z"]))
            self.force = service.force
        if not service.silent:
            self.write_message(json.dumps(service.state()))

    def on_close(self):
        self.service.clients.discard(self)
        self.service.left_behind.append(self.force)
        self.service.take_force((0.0, 0.0, 0.0))  # a device without a session makes no force


class InverseService:
    """@param position tip, m, in the service's frame: x right, y forward, z up."""

    def __init__(self, device_id="049D", position=(0.0, -0.12, 0.15)):
        self.device_id, self.position, self.buttons = device_id, list(position), {"a": False, "b": False, "c": False}
        self.silent, self.calibrated, self.velocity = False, True, (0.0, 0.0, 0.0)
        self.force, self.peak, self.forces, self.complaints, self.clients = (0.0, 0.0, 0.0), 0.0, 0, [], set()
        self.late_s, self.left_behind = 0.0, []  # seconds an answer is late; the last force of each ended connection
        self.force_changed_at = time.monotonic()
        self._ready = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._serve()), daemon=True)
        self._thread.start()
        self._ready.wait()

    async def _serve(self):
        self._loop, self._end = asyncio.get_running_loop(), asyncio.Event()
        self.sockets = tornado.netutil.bind_sockets(0, "127.0.0.1")
        self.port = self.sockets[0].getsockname()[1]
        server = tornado.httpserver.HTTPServer(tornado.web.Application([("/", Socket, {"service": self})]))
        server.add_sockets(self.sockets)
        self._ready.set()
        await self._end.wait()
        server.stop()
        for client in list(self.clients):
            client.close()

    @property
    def url(self):
        return f"ws://127.0.0.1:{self.port}"

    def take_force(self, force):
        self.forces += 1
        self.peak = max(self.peak, sum(f * f for f in force) ** 0.5)
        if force != self.force:
            self.force, self.force_changed_at = force, time.monotonic()

    @staticmethod
    def vector(values):
        return dict(zip("xyz", values))

    def state(self):
        return {"inverse3": [{"device_id": self.device_id,
                              "status": {"calibrated": self.calibrated, "in_use": False, "power_supply": True, "ready": True, "started": True},
                              "state": {"mode": "idle", "cursor_position": self.vector(self.position), "cursor_velocity": self.vector(self.velocity),
                                        "current_cursor_force": self.vector(self.force)}}],
                "wireless_verse_grip": [{"device_id": "61548", "status": {"ready": True, "connected": True, "awake": True},
                                         "state": {"buttons": dict(self.buttons), "hall": 0, "battery_level": 0.9,
                                                                         "orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}}}]}

    def everything(self):
        """The first message, which the service sends by itself."""
        whole = self.state()
        whole["session_id"] = 7
        version = {"major_version": 3, "minor_version": 1, "id": self.device_id, "device_type": 4, "uuid": "0" * 32}
        whole["inverse3"][0]["config"] = {
            "type": "inverse3", "handedness": "right", "port": "COM3", "device_info": version, "extended_device_id": "0" * 32,
            "extended_firmware_version": "0" * 32, "gravity_compensation": {"enabled": True, "scaling_factor": 0.8},
            "torque_scaling": {"enabled": True}}
        return whole

    def press(self, **buttons):
        self.buttons.update(buttons)

    def drop_clients(self):
        """Ends every connection without a farewell."""
        self._loop.call_soon_threadsafe(lambda: [client.stream.close() if client.ws_connection is None else client.ws_connection._abort() for client in list(self.clients)])

    def stop(self):
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join()
