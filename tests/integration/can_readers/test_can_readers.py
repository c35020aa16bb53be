"""The C++ codec, the EDS and the DBC agree, as checked with cantools and python-canopen, which share no code with us.
"""

import io
import json
import os
import pathlib
import random
import subprocess
import sys
import unittest

import canopen
import cantools

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from seeds import shifted  # noqa: E402

DESCRIBE = os.environ["LIGATURE_DESCRIBE"]
NODES = {1: "Waist", 2: "Shoulder", 3: "Elbow"}
ROUNDS = 2000
SEED = shifted(20260101)


def describe(*args, lines=None):
    """Runs the generator; with `lines`, feeds them to it and returns its output lines."""
    given = None if lines is None else "\n".join(lines) + "\n"
    result = subprocess.run([DESCRIBE, *map(str, args)], input=given, capture_output=True, text=True, timeout=60, check=True)
    return result.stdout if lines is None else result.stdout.splitlines()


class Readers(unittest.TestCase):
    def setUp(self):
        self.random = random.Random(SEED)
        self.dbc = cantools.database.load_string(describe("dbc"), "dbc")
        self.constants = json.loads(describe("constants"))

    def eds(self, node):
        text = io.StringIO(describe("eds", node))
        text.name = f"node-{node}.eds"
        return canopen.import_od(text, node_id=node)

    def words(self, kind, node):
        """Random field values of one PDO, extremes included: in the order of our encode line, and by signal name."""
        def pick(low, high):
            return self.random.choice([low, high, 0, self.random.randint(low, high)])

        if kind == "rpdo1":
            named = {"Controlword": pick(0, 0xFFFF), "TargetTorque": pick(-3000, 3000)}
            return list(named.values()), named
        named = {"Statusword": pick(0, 0xFFFF), "PositionActual": pick(-2**31, 2**31 - 1)}
        last = "StylusButtons" if node == 3 else "TorqueActual"
        named[last] = pick(0, 0xFFFF) if node == 3 else pick(-2**15, 2**15 - 1)
        line = [named["Statusword"], named["PositionActual"], named.get("TorqueActual", 0), named.get("StylusButtons", 0)]
        return line, named

    def random_pdos(self):
        for _ in range(ROUNDS):
            kind, node = self.random.choice(["tpdo1", "rpdo1"]), self.random.choice(list(NODES))
            yield kind, node, *self.words(kind, node)

    def test_cantools_decodes_what_the_codec_encodes(self):
        pdos = list(self.random_pdos())
        frames = describe("encode", lines=[" ".join(map(str, (kind, node, *line))) for kind, node, line, _ in pdos])
        for (kind, node, _, named), frame in zip(pdos, frames, strict=True):
            identifier, data = frame.split()
            message = self.dbc.get_message_by_frame_id(int(identifier, 16))
            self.assertEqual(message.name, f"{NODES[node]}_{kind.upper()}")
            self.assertEqual(message.length, len(data) // 2)
            self.assertEqual(message.decode(bytes.fromhex(data)), named)

    def test_the_codec_decodes_what_cantools_encodes(self):
        pdos = list(self.random_pdos())
        frames = []
        for kind, node, _, named in pdos:
            message = self.dbc.get_message_by_name(f"{NODES[node]}_{kind.upper()}")
            frames.append(f"{message.frame_id:X} {message.encode(named).hex()}")
        for (kind, node, line, _), answer in zip(pdos, describe("decode", lines=frames), strict=True):
            self.assertEqual(answer, " ".join(map(str, (kind, node, *line))))

    def test_canopen_maps_the_pdos_of_the_eds_as_the_codec_does(self):
        for node in NODES:
            drive = canopen.LocalNode(node, self.eds(node))
            # A network without bus, needed because reading a PDO map subscribes to the network.
            canopen.Network().add_node(drive)
            for pdo, kind, base in ((drive.tpdo[1], "tpdo1", 0x180), (drive.rpdo[1], "rpdo1", 0x200)):
                pdo.read(from_od=True)
                self.assertEqual(pdo.cob_id, base + node)
                self.assertEqual(pdo.trans_type, 1)
                expected = [f for f in self.constants["fields"] if f["pdo"] == kind and f["node"] == node]
                got = [(v.index, v.subindex, v.length, v.offset) for v in pdo.map]
                self.assertEqual(got, [(f["index"], f["sub"], f["bits"], f["offset_bits"]) for f in expected])
                line, named = self.words(kind, node)
                frame = describe("encode", lines=[" ".join(map(str, (kind, node, *line)))])[0].split()
                pdo.data[:] = bytes.fromhex(frame[1])
                for variable, field in zip(pdo.map, expected, strict=True):
                    self.assertEqual(variable.raw, named[field["name"]], f"node {node}: {field['name']}")

    def test_the_dbc_knows_every_service_of_the_bus(self):
        frames = {0x000: "0101", 0x080: "", 0x77F: "05"}
        for node in NODES:
            frames |= {0x080 + node: "5082110000000000", 0x180 + node: "00" * 8, 0x200 + node: "00" * 4, 0x580 + node: "4F61600A00000000",
                       0x600 + node: "2F6060000A000000", 0x700 + node: "7F"}
        for identifier, data in frames.items():
            self.dbc.get_message_by_frame_id(identifier).decode(bytes.fromhex(data), allow_truncated=False, allow_excess=False)
        self.assertEqual({m.frame_id for m in self.dbc.messages}, set(frames))
        self.assertEqual(self.dbc.decode_message(0x082, bytes.fromhex(frames[0x082]))["ErrorCode"], 0x8250)

    def test_dbc_and_eds_agree_on_every_signal(self):
        for field in self.constants["fields"]:
            message = self.dbc.get_message_by_name(f"{NODES[field['node']]}_{field['pdo'].upper()}")
            signal = message.get_signal_by_name(field["name"])
            self.assertEqual((signal.start, signal.length, signal.is_signed, signal.byte_order),
                             (field["offset_bits"], field["bits"], field["signed"], "little_endian"))
            entry = self.eds(field["node"])[field["index"]]
            variable = entry if isinstance(entry, canopen.objectdictionary.ODVariable) else entry[field["sub"]]
            self.assertEqual(len(variable), field["bits"])
            self.assertEqual(variable.data_type in canopen.objectdictionary.SIGNED_TYPES, field["signed"])
            self.assertTrue(variable.pdo_mappable)

    def test_drive_constants_of_the_eds_are_those_of_the_code(self):
        for node in NODES:
            eds = self.eds(node)
            self.assertEqual(eds[0x6076].default, self.constants["rated_torque_mNm"])
            self.assertEqual(eds[0x6072].default, self.constants["max_torque_permille"])
            self.assertEqual(eds[0x608F][1].default, self.constants["counts_per_revolution"])
            self.assertEqual(eds[0x1000].default & 0xFFFF, 402)

    def test_bad_lines_are_refused_with_their_number(self):
        for command, line in (("encode", "tpdo1 7 0 0 0 0"), ("encode", "rpdo1 1 nine 0"), ("decode", "181 0"), ("decode", "XYZ 00")):
            result = subprocess.run([DESCRIBE, command], input=line + "\n", capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 2)
            self.assertIn("stdin:1", result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
