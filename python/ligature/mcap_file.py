"""Recordings that `ligature-host export --mcap` has written (host/export_mcap.cpp), read by the package `mcap`."""

import json
from collections.abc import Callable
from typing import Any

import numpy as np

from ligature import _core

MAGIC = b"\x89MCAP0\r\n"  # the first bytes of every MCAP file
COLUMNS: dict[str, tuple[str, str]] = _core._tick_meanings()
HANDS = ("left", "right")  # their columns are on the topics /left and /right, without the prefix; the rest is on /rig


def is_mcap(path: str) -> bool:
    """Does the file begin as MCAP files do? False for a file that cannot be opened."""
    try:
        with open(path, "rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


class McapFile:
    """The content of a file, with the names that _core._read_recording gives to it."""

    damage = ""

    def __init__(self, path: str) -> None:
        try:
            from mcap.reader import make_reader
        except ImportError:
            raise _core.Refusal(f"{path}: is an MCAP file, which needs the package mcap: pip install 'ligature[mcap]'") from None
        self._messages: dict[str, list[dict[str, Any]]] = {}
        self._kinds: dict[str, dict[str, Any]] = {}  # of each topic: its fields
        try:
            with open(path, "rb") as file:
                self._take(make_reader(file))
        except Exception as why:  # also errors of the packages that decompress; the file may be anybody's
            raise _core.Refusal(f"{path}: found a damaged MCAP file, or one that `ligature-host export` of this version has "
                                f"not written ({type(why).__name__}: {why})") from None
        if self._ticks["tick"].size == 0:
            raise _core.Refusal(f"{path}: holds no tick")

    def _take(self, reader: Any) -> None:
        for schema, channel, message in reader.iter_messages(log_time_order=False):  # in the order of the recording
            if channel.topic not in self._messages:
                self._kinds[channel.topic] = json.loads(schema.data)["properties"]
                self._messages[channel.topic] = []
            self._messages[channel.topic].append(json.loads(message.data))
        facts = {record.name: record.metadata for record in reader.iter_metadata()}["ligature"]
        self.period_s = float(facts["period_s"])
        self.max_force_N = float(facts["max_force_N"])
        self.firmware_version: str = facts["firmware_version"]
        self._ticks, self._shapes, self._events = self._read_ticks(), self._read_shapes(), self._read_events()
        texts = sorted((int(a.name[len("scene-"):-len(".toml")]), a) for a in reader.iter_attachments())
        self._scenes = [(self._time_s(round(1e-9 * a.log_time / self.period_s)), facts[a.name], a.data.decode())
                        for _, a in texts]

    def ticks(self) -> dict[str, np.ndarray]:
        return self._ticks

    def shapes(self) -> dict[str, np.ndarray]:
        return self._shapes

    def events(self) -> list[tuple[Any, ...]]:
        return self._events

    def scenes(self) -> list[tuple[float, str, str]]:
        return self._scenes

    @property
    def missing(self) -> int:
        session, tick = self._ticks["session"], self._ticks["tick"]
        return sum(int(np.ptp(tick[session == s])) + 1 - int(np.sum(session == s)) for s in np.unique(session))

    def _time_s(self, tick: Any) -> Any:
        """As host/rig_facts.hpp: dividing by an integer rate gives the nearest decimal number."""
        rate_Hz = 1.0 / self.period_s
        return tick / round(rate_Hz) if abs(rate_Hz - round(rate_Hz)) <= 1e-12 * rate_Hz else tick * self.period_s

    def _column(self, topic: str, field: str) -> np.ndarray:
        kind = np.int64 if self._kinds[topic][field]["type"] == "integer" else np.float64
        return _frozen(np.array([message[field] for message in self._messages[topic]], dtype=kind))  # null becomes NaN

    def _read_ticks(self) -> dict[str, np.ndarray]:
        columns = {"t_s": _frozen(self._time_s(self._column("/rig", "tick")))}
        for name in COLUMNS:
            hand = name.split("_")[0]
            if name != "t_s":
                columns[name] = self._column("/" + hand, name[len(hand) + 1:]) if hand in HANDS else self._column("/rig", name)
        return columns

    def _read_shapes(self) -> dict[str, np.ndarray]:
        entities = [message["entities"][0] for message in self._messages.get("/thread", [])]
        at_s = [entity["timestamp"]["sec"] + 1e-9 * entity["timestamp"]["nsec"] for entity in entities]
        tick = np.array([round(s / self.period_s) for s in at_s], dtype=np.int64)
        lines = [entity["lines"][0] for entity in entities]
        points = [[point["x"], point["y"], point["z"]] for line in lines for point in line["points"]]
        return {"t_s": _frozen(np.asarray(self._time_s(tick), dtype=np.float64)), "tick": _frozen(tick),
                "count": np.array([len(line["points"]) for line in lines], dtype=np.int64),
                "radius_m": _frozen(np.array([0.5 * line["thickness"] for line in lines], dtype=np.float32)),
                "p_W_m": _frozen(np.array(points, dtype=np.float32).reshape(-1, 3))}

    def _read_events(self) -> list[tuple[Any, ...]]:
        return [(self._time_s(e["tick"]), e["tick"], e["kind"], e["hand"], e["code"], e["text"])
                for e in self._messages.get("/events", [])]


def _frozen(array: np.ndarray) -> np.ndarray:
    array.flags.writeable = False
    return array


def reader_of(path: str) -> Callable[[str], Any]:
    """What reads this file: the programs' own reader, or McapFile."""
    return McapFile if is_mcap(path) else _core._read_recording
