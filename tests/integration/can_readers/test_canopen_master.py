"""python-canopen as the master of a simulated hand: an independent implementation of the standard against ours.

Real processes without time limits: every wait is for a condition, with a limit that only ends a hang."""

import io
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import can
import canopen
from local_bus import LocalBus

DEVICE, DESCRIBE = os.environ["LIGATURE_DEVICE"], os.environ["LIGATURE_DESCRIBE"]
NODES = (1, 2, 3)
BOUND_S = 20
SHUTDOWN, SWITCH_ON, ENABLE, FAULT_RESET = 0x06, 0x07, 0x0F, 0x80


class Hand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hand-")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        interface = os.environ.get("LIGATURE_HAND_CAN")  # a SocketCAN interface that is up, instead of a `local:` bus
        bus = f"socketcan:{interface}" if interface else f"local:{self.path / 'bus'}"
        with open(self.path / "device.log", "w") as log:
            self.device = subprocess.Popen([DEVICE, "--hand", "left", "--bus", bus, "--stats", self.path / "stats.json"], stdout=log)
        self.addCleanup(self.end)
        self.wait_for(lambda: "waiting for a controller" in (self.path / "device.log").read_text(), "the bus")
        self.network = canopen.Network(can.Bus(interface, interface="socketcan") if interface else LocalBus(self.path / "bus"))
        self.network.connect()
        for node in NODES:
            text = io.StringIO(subprocess.run([DESCRIBE, "eds", str(node)], capture_output=True, text=True, check=True).stdout)
            text.name = f"node-{node}.eds"
            self.network.add_node(canopen.RemoteNode(node, canopen.import_od(text, node)))
        self.drives = [self.network[node] for node in NODES]
        # canopen's own waits miss answers that came before the call; three drives answer at once, so receptions are
        # counted.
        self.boots, self.tpdos = dict.fromkeys(NODES, 0), dict.fromkeys(NODES, 0)
        for node in NODES:
            self.network.subscribe(0x700 + node, lambda id, data, _: self.count(self.boots, id - 0x700, data[0] == 0))
            self.network.subscribe(0x180 + node, lambda id, data, _: self.count(self.tpdos, id - 0x180))

    @staticmethod
    def count(what, node, counts=True):
        what[node] += counts

    def end(self):
        """Ends the device with SIGTERM. @return its exit code and its statistics."""
        if hasattr(self, "network"):
            self.network.disconnect()  # before the bus is closed
        self.device.send_signal(signal.SIGTERM)
        code = self.device.wait(timeout=BOUND_S)
        stats = self.path / "stats.json"
        return code, json.loads(stats.read_text()) if stats.exists() else None

    def wait_for(self, condition, what):
        bound = time.monotonic() + BOUND_S
        while not condition():
            self.assertLess(time.monotonic(), bound, f"{what} did not come")
            time.sleep(0.001)

    def start_up(self, rpdo_timeout_ms=0):
        """Boot-up, parameters by SDO, PDO maps as read from the drives, NMT start."""
        self.network.nmt.send_command(0x82)
        self.wait_for(lambda: all(self.boots.values()), "a boot-up of every drive")
        for drive in self.drives:
            drive.sdo[0x6060].raw = 10
            drive.sdo[0x1400][5].raw = rpdo_timeout_ms
            drive.tpdo.read()
            drive.rpdo.read()
        self.network.nmt.state = "OPERATIONAL"

    def command(self, word, torque=0):
        """Sends an RPDO to every drive, then a SYNC. At the SYNC the RPDO acts; the samples are of the state just
        before."""
        for drive in self.drives:
            drive.rpdo[1]["Controlword"].raw = word
            drive.rpdo[1]["TargetTorque"].raw = torque
            drive.rpdo[1].transmit()
        self.sync()

    def sync(self):
        before = dict(self.tpdos)
        self.network.sync.transmit()
        self.wait_for(lambda: all(self.tpdos[n] > before[n] for n in NODES), "a TPDO of every drive")

    def state(self):
        self.sync()
        return {drive.tpdo[1]["Statusword"].raw & 0x6F for drive in self.drives}

    def enable(self):
        for word in (SHUTDOWN, SWITCH_ON, ENABLE):
            self.command(word)
        self.assertEqual(self.state(), {0x27})

    def test_a_canopen_master_enables_the_drives_and_reads_their_process_data(self):
        self.start_up()
        self.assertEqual(self.state(), {0x40})
        self.enable()
        self.command(ENABLE, torque=200)
        self.sync()
        self.assertEqual([d.tpdo[1]["TorqueActual"].raw for d in self.drives[:2]], [200, 200])
        self.assertEqual(self.drives[2].tpdo[1]["Stylus.StylusButtons"].raw & 2, 2, "the operator holds the dead-man from the start")
        code, stats = self.end()
        self.assertEqual((code, stats["final_torque_permille"]), (0, [200, 200, 200]), "no watchdog was asked for: torque holds")

    def test_objects_are_as_the_eds_says(self):
        for drive in self.drives:
            self.assertEqual(drive.sdo[0x1000].raw & 0xFFFF, 402)
            self.assertEqual(drive.sdo[0x6076].raw, 300)
            self.assertEqual(drive.sdo[0x608F][1].raw, 16384)
            with self.assertRaises(canopen.SdoAbortedError) as refused:
                drive.sdo[0x6060].raw = 8
            self.assertEqual(refused.exception.code, 0x06090030)

    def test_silence_is_told_by_emcy_and_left_by_fault_reset(self):
        self.start_up(rpdo_timeout_ms=2000)  # long timeout, so that a loaded machine does not let it expire early
        self.enable()
        self.wait_for(lambda: all(d.emcy.active for d in self.drives), "an EMCY of every drive")
        self.assertEqual({d.emcy.active[-1].code for d in self.drives}, {0x8250})
        self.assertEqual({s & 0x4F for s in self.state()}, {0x08})
        self.command(ENABLE, torque=500)
        self.assertEqual({s & 0x4F for s in self.state()}, {0x08}, "a command left the fault")
        self.command(FAULT_RESET)
        self.assertEqual(self.state(), {0x40})
        self.enable()
        _, stats = self.end()
        self.assertEqual(stats["watchdog_trips"], 3)

    def test_a_lost_heartbeat_of_the_master_is_told_by_emcy(self):
        self.start_up()
        for drive in self.drives:
            drive.sdo[0x1016][1].raw = 127 << 16 | 1500  # ms; monitoring starts with the first heartbeat
        self.enable()
        self.command(ENABLE, torque=200)
        self.network.send_message(0x77F, [0x05])
        self.wait_for(lambda: all(d.emcy.active for d in self.drives), "an EMCY of every drive")
        self.assertEqual({d.emcy.active[-1].code for d in self.drives}, {0x8130})
        self.assertEqual({s & 0x4F for s in self.state()}, {0x08})
        _, stats = self.end()
        self.assertEqual((stats["watchdog_trips"], stats["final_torque_permille"]), (3, [0, 0, 0]))


class CommandLine(unittest.TestCase):
    def refused(self, *args):
        result = subprocess.run([DEVICE, *args], capture_output=True, text=True, timeout=BOUND_S)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        return result.stderr

    def test_bad_usage_is_refused_in_one_line(self):
        self.assertIn("--hand", self.refused("--bus", "local:x"))
        self.assertIn("middle", self.refused("--hand", "middle", "--bus", "local:x"))
        self.assertIn("smoke", self.refused("--hand", "left", "--bus", "smoke:signals"))
        self.assertIn("nowhere", self.refused("--hand", "left", "--bus", "local:/nowhere/at/all"))
        self.assertIn("nowhere", self.refused("--hand", "left", "--bus", "local:bus", "--stats", "/nowhere/stats.json"))
        self.assertIn("nocan7", self.refused("--hand", "left", "--bus", "socketcan:nocan7"))
        self.assertFalse(pathlib.Path("bus").exists())

    def test_help_teaches(self):
        text = subprocess.run([DEVICE, "--help"], capture_output=True, text=True, timeout=BOUND_S, check=True).stdout
        self.assertIn("Example", text)
        self.assertIn("ligature-device", subprocess.run([DEVICE, "--version"], capture_output=True, text=True, check=True).stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
