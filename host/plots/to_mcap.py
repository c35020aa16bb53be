"""Writes what `ligature-host export --hdf5` made as MCAP, for viewers: JSON messages with their schemas.

python3 to_mcap.py recording.h5 --out recording.mcap
Needs h5py and mcap. Topics and layout: docs/analysis.md. The file appears under its name when it is complete.
"""

import argparse
import json
import os
import sys

import h5py
from mcap.writer import CompressionType, Writer

BLOCK = 20_000  # rows read at a time
HANDS = ("left", "right")
COLOUR = {"r": 0.85, "g": 0.73, "b": 0.5, "a": 1.0}
LINE_STRIP = 0  # value in foxglove.LinePrimitive


def schema_of(title, properties):
    return json.dumps({"title": title, "type": "object", "properties": properties})


def field(dataset):
    unit = dataset.attrs.get("unit", "")
    kind = "number" if dataset.dtype.kind == "f" else "integer"
    return {"type": kind, "description": dataset.attrs.get("meaning", "") + (f" [{unit}]" if unit else "")}


def split(names):
    """Sorts column names by topic: one topic per hand (names that start with "left_" or "right_"), the rest on /rig."""
    topics = {"/rig": {}}
    for name in names:
        hand = next((h for h in HANDS if name.startswith(h + "_")), None)
        topics.setdefault(f"/{hand}" if hand else "/rig", {})[name] = name[len(hand) + 1:] if hand else name
    return topics


class Recording:
    def __init__(self, writer, source):
        self.writer, self.source = writer, source

    def channel(self, topic, title, properties):
        schema = self.writer.register_schema(name=title, encoding="jsonschema", data=schema_of(title, properties).encode())
        return self.writer.register_channel(topic=topic, message_encoding="json", schema_id=schema)

    def say(self, channel, t_s, message):
        at = int(round(t_s * 1e9))
        self.writer.add_message(channel_id=channel, log_time=at, publish_time=at, data=json.dumps(message).encode())

    def ticks(self):
        group = self.source["ticks"]
        names = [name for name in group if name != "t_s"]
        topics = split(names)
        channels = {topic: self.channel(topic, f"ligature{topic.replace('/', '.')}", {short: field(group[name]) for name, short in columns.items()})
                    for topic, columns in topics.items()}
        total = group["t_s"].shape[0]
        for start in range(0, total, BLOCK):
            part = slice(start, min(start + BLOCK, total))
            time = group["t_s"][part]
            for topic, columns in topics.items():
                shorts = list(columns.values())
                rows = zip(*(group[name][part].tolist() for name in columns))
                for t_s, row in zip(time, rows):
                    self.say(channels[topic], t_s, dict(zip(shorts, row)))

    def shapes(self):
        """Writes shapes as foxglove.SceneUpdate: viewers that support it draw the thread as a line of its true
        thickness.
        """
        group = self.source["shapes"]
        channel = self.channel("/thread", "foxglove.SceneUpdate", {"entities": {"type": "array", "items": {"type": "object"}}})
        pose = {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
        for t_s, first, count, radius_m in zip(group["t_s"], group["first"], group["count"], group["radius_m"]):
            points = [{"x": x, "y": y, "z": z} for x, y, z in group["p_W_m"][first:first + count].tolist()]
            line = {"type": LINE_STRIP, "pose": pose, "thickness": 2 * float(radius_m), "scale_invariant": False, "points": points,
                    "color": COLOUR, "colors": [], "indices": []}
            stamp = {"sec": int(t_s), "nsec": int(round(t_s % 1 * 1e9)) % 1_000_000_000}
            entity = {"timestamp": stamp, "frame_id": "W", "id": "thread", "lifetime": {"sec": 0, "nsec": 0}, "frame_locked": False,
                      "metadata": [], "arrows": [], "cubes": [], "spheres": [], "cylinders": [], "lines": [line], "triangles": [], "texts": [], "models": []}
            self.say(channel, t_s, {"deletions": [], "entities": [entity]})

    def events(self):
        group = self.source["events"]
        columns = [name for name in group if name != "t_s"]
        channel = self.channel("/events", "ligature.event", {name: {"type": "string"} if name == "text" else field(group[name]) for name in columns})
        values = {name: group[name].asstr()[:] if name == "text" else group[name][:].tolist() for name in columns}
        for i, t_s in enumerate(group["t_s"][:]):
            self.say(channel, t_s, {name: values[name][i] for name in columns})

    def facts(self):
        facts = {name: str(value) for name, value in self.source.attrs.items()}
        self.writer.add_metadata("ligature", facts)
        group = self.source["scenes"]
        for i, (t_s, file, toml) in enumerate(zip(group["t_s"][:], group["file"].asstr()[:], group["toml"].asstr()[:])):
            self.writer.add_attachment(create_time=0, log_time=int(t_s * 1e9), name=f"scene-{i + 1}.toml", media_type="application/toml", data=toml.encode())


def convert(path, out):
    part = f"{out}.part-{os.getpid()}"
    try:
        with h5py.File(path) as source, open(part, "wb") as file:
            writer = Writer(file, compression=CompressionType.ZSTD)
            writer.start(profile="", library=f"ligature-host {source.attrs['host_version']}")
            recording = Recording(writer, source)
            recording.facts()
            recording.ticks()
            recording.shapes()
            recording.events()
            writer.finish()
        os.replace(part, out)
    finally:
        if os.path.exists(part):
            os.remove(part)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()
    try:
        convert(arguments.recording, arguments.out)
    except (OSError, ValueError, KeyError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
