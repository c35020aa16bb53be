"""The overhand in a loop for minutes, firmware and both hands as processes: what must not change in time does not.

Between two rounds the hands let go and the thread is reset. Judged: every tick recorded, the schedule on its grid to the
nanosecond, no page fault and no growth of the firmware after its start; each late tick with its cause, none of which may
be that the loop itself computed for longer. Wall time is told, not judged: this machine may be anybody's.

With --disk another process writes to the recorder's disk all the while, 512 MB after 512 MB, each until it is synced.

Usage: soak.py MINUTES [--disk] (scripts/soak sets the environment). Exit: 0, or 3 when something changed that must not.
"""

import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

ROOT = pathlib.Path(os.environ["LIGATURE_SOURCE"])
BIN = pathlib.Path(os.environ["LIGATURE_BIN"])
ROUND_S, REST_AT_S = 24.0, 22.2  # the script takes 21 s
PERIOD_NS = 1_000_000
HEADER_BYTES = 65536
SETTLED_S = 5.0
LOST, MISSED, OVERWORKED = 1, 2, 128
BUS_NS = 460_000  # what SYNC and TPDOs take

# Of protocol/recorder/flight_file.hpp and tick_t.lcm, the first fields.
TICK = [("sequence", "<u8"), ("bytes", "<u4"), ("crc", "<u4"), ("tick", ">i8"), ("scheduled_ns", ">i8"), ("wakeup", ">i4"), ("sync", ">i4"),
        ("tpdo", ">i4"), ("law", ">i4"), ("control", ">i4"), ("execution", ">i4"), ("flags", ">i4"), ("state", "i1"), ("fault", ">i2")]


def script_in_a_loop(folder, rounds):
    lines = [line for line in (ROOT / "scenes/operators/overhand.csv").read_text().splitlines() if line and not line.startswith("#")]
    keys = [line.split(",") for line in lines[1:]]
    with open(folder / "loop.csv", "w") as out:
        out.write(lines[0] + "\n")
        for i in range(rounds):
            for t, *rest in keys:
                out.write(",".join([f"{float(t) + i * ROUND_S:.3f}", *rest]) + "\n")
    return folder / "loop.csv"


class Firmware:
    """What Linux says of the process and of its real-time thread."""

    def __init__(self, pid):
        self.pid = pid
        self.loop = next((t for t in os.listdir(f"/proc/{pid}/task") if os.sched_getscheduler(int(t)) == os.SCHED_FIFO), str(pid))

    def faults(self):
        """(minor, major) of the real-time thread."""
        fields = pathlib.Path(f"/proc/{self.pid}/task/{self.loop}/stat").read_text().rsplit(")", 1)[1].split()
        return int(fields[7]), int(fields[9])

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.pid}/task/{self.loop}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory_kB(self):
        lines = pathlib.Path(f"/proc/{self.pid}/status").read_text().splitlines()
        return {line.split(":")[0]: int(line.split()[1]) for line in lines if line.startswith(("VmSize", "VmRSS", "VmData"))}


class DiskLoad(threading.Thread):
    """Keeps the disk of a folder busy; each writer ends by itself."""

    def __init__(self, folder):
        super().__init__(daemon=True)
        self.file, self.over, self.written_MB = folder / "load", threading.Event(), 0

    def run(self):
        while not self.over.wait(0.5):
            subprocess.run(["nice", "-n", "10", "ionice", "-c", "2", "-n", "7", "dd", "if=/dev/zero", f"of={self.file}", "bs=1M", "count=512",
                            "conv=fdatasync"], stderr=subprocess.DEVNULL, check=True)
            self.written_MB += 512


def ticks_of(file):
    with open(file, "rb") as opened:
        slot = struct.unpack("<8sII", opened.read(16))[2]
        opened.seek(HEADER_BYTES)
        _, bytes_ = struct.unpack("<QI", opened.read(12))
    named = dict(TICK)
    contacts_at = 16 + bytes_ - 26  # int16_t contacts, int8_t degradation, and 23 bytes about the thread's own time
    offsets = np.cumsum([0] + [np.dtype(t).itemsize for t in named.values()])[:-1].tolist()
    layout = {"names": [*named, "contacts"], "formats": [*named.values(), ">i2"], "offsets": [*offsets, contacts_at], "itemsize": slot}
    raw = np.fromfile(file, dtype=np.dtype(layout), offset=HEADER_BYTES)
    raw = raw[raw["sequence"] > 0]
    return raw[np.argsort(raw["sequence"])]


def quantiles(values_ns):
    us = np.sort(values_ns.astype(float)) / 1e3
    at = [us[min(len(us) - 1, int(q * len(us)))] for q in (0.5, 0.99, 0.999, 0.9999)]
    return "  ".join(f"{v:9.1f}" for v in (*at, us[-1]))


def say(line):
    print(f"soak: {line}", flush=True)


def judge(ticks, before, after):
    """@return what is wrong."""
    wrong = []
    if not np.array_equal(ticks["tick"], np.arange(len(ticks))):
        wrong.append("a tick is missing from the recorder")
    if np.any(np.diff(ticks["scheduled_ns"]) != PERIOD_NS):
        wrong.append("the schedule has left its grid")
    if np.any(ticks["fault"] != 0):
        wrong.append(f"fault {ticks['fault'].max()} at tick {ticks['tick'][ticks['fault'] != 0][0]}")
    if after["faults"] != before["faults"]:
        wrong.append(f"page faults of the loop {before['faults']} -> {after['faults']}")
    for what in ("VmSize", "VmData", "VmRSS"):
        if after["memory"][what] != before["memory"][what]:
            wrong.append(f"{what} {before['memory'][what]} -> {after['memory'][what]} kB")
    return wrong


def causes(done, waiting, computing):
    """@return how many late ticks woke up late, waited for a hand, or were kept from computing; and apart those whose own
    CPU time, which the loop reads when the samples are in and at the end, is more than the bus leaves of a period: only these are the
    program's."""
    names = {"woke up late": 0, "waited for a hand": 0, "were kept from computing": 0, "worked for too long": 0}
    told = []
    for tick, waited, took in zip(done, waiting, computing):
        if tick["flags"] & OVERWORKED:
            name = "worked for too long"
            told.append((took, f"tick {tick['tick']}: {tick['contacts']} contacts, computing took {took / 1e3:.0f} us by the wall"))
        elif not tick["flags"] & MISSED:
            continue
        else:
            lost_ns = {"woke up late": tick["wakeup"], "waited for a hand": waited - BUS_NS, "were kept from computing": took}
            name = max(lost_ns, key=lost_ns.get)
        names[name] += 1
    for _, line in sorted(told)[-5:]:
        say(line)
    return names


def report(ticks):
    """@return how many ticks worked for longer than there is time."""
    lost = ticks["flags"] & LOST != 0
    done = ticks[~lost]
    waiting = done["tpdo"] - done["sync"]
    computing = done["execution"] - waiting
    late = done["flags"] & MISSED != 0
    say(f"{len(ticks)} periods, {len(done)} executed ({100 * len(done) / len(ticks):.3f} %), {late.sum()} finished late, {lost.sum()} lost")
    say("us                       p50        p99      p99.9     p99.99      worst")
    for name, values in (("wake-up", done["wakeup"]), ("waiting for the hands", waiting), ("computing", computing), ("whole tick", done["execution"])):
        say(f"{name:22}{quantiles(values)}")
    names = causes(done, waiting, computing)
    say("late ticks: " + ", ".join(f"{n} {name}" for name, n in names.items()))
    p999 = np.sort(computing)[int(0.999 * len(computing))]
    say(f"computing, p99.9: {p999 / PERIOD_NS * 100:.1f} % of the period (bar 40 %)")
    return names["worked for too long"]


def main():
    minutes, loads_disk = float(sys.argv[1]), "--disk" in sys.argv[2:]
    rounds = max(1, int(np.ceil(minutes * 60 / ROUND_S)))
    with tempfile.TemporaryDirectory(prefix="soak-") as name:
        folder = pathlib.Path(name)
        loop = script_in_a_loop(folder, rounds)
        started = []
        disk = DiskLoad(folder)

        def start(program, *args):
            with open(folder / f"{len(started)}.log", "w") as log:
                started.append(subprocess.Popen([BIN / program, *map(str, args)], cwd=ROOT, stdout=log, stderr=log))
            return started[-1]

        try:
            buses = {hand: f"local:{folder / hand}" for hand in ("left", "right")}
            for hand, bus in buses.items():
                start("ligature-device", "--rt", "--hand", hand, "--bus", bus, "--scene", "scenes/paper.toml", "--operator", loop)
            length_s = rounds * ROUND_S
            firmware = start("ligature-firmware", "run", "--scene", "scenes/paper.toml", "--left", buses["left"], "--right", buses["right"],
                             "--arm", "--duration", length_s, "--watchdog-ms", 1000, "--recorder", folder / "flight.rec",
                             "--recorder-s", int(length_s) + 30)
            say(f"{rounds} rounds, {length_s:.0f} s; load {os.getloadavg()[0]:.1f}")
            time.sleep(SETTLED_S)
            if firmware.poll() is not None:
                print((folder / "2.log").read_text())
                return 3
            linux = Firmware(firmware.pid)
            if loads_disk:
                disk.start()
            before = {"faults": linux.faults(), "memory": linux.memory_kB()}
            began = time.monotonic() - SETTLED_S
            for i in range(rounds):
                while firmware.poll() is None and time.monotonic() < began + i * ROUND_S + REST_AT_S + 0.8:
                    time.sleep(0.2)
                    if time.monotonic() < began + length_s - 3:
                        after = {"faults": linux.faults(), "memory": linux.memory_kB(), "cpu_s": linux.cpu_s()}
                if i + 1 < rounds:
                    subprocess.run([BIN / "ligature-host", "send", "reset-thread"], capture_output=True, timeout=30)
                    say(f"round {i + 1} of {rounds}, memory {after['memory']['VmRSS']} kB, page faults {after['faults']}, load {os.getloadavg()[0]:.1f}")
            code = firmware.wait(timeout=120)
            say(f"firmware: exit {code}, loop used {after['cpu_s']:.1f} s of CPU; load {os.getloadavg()[0]:.1f}")
            print((folder / "2.log").read_text())
            ticks = ticks_of(folder / "flight.rec")
            wrong = judge(ticks, before, after)
            if (long := report(ticks)) > 0:
                wrong.append(f"{long} ticks worked for too long")
            if loads_disk:
                say(f"beside it {disk.written_MB} MB were written to the same disk")
        finally:
            disk.over.set()
            if disk.is_alive():
                disk.join()
            for process in started:
                if process.poll() is None:
                    process.send_signal(signal.SIGTERM)
                process.wait(timeout=20)
        for line in wrong:
            say("NOT MET: " + line)
        if not wrong:
            say("every tick recorded, schedule on its grid, no page fault, memory flat")
        return 3 if wrong or code else 0


if __name__ == "__main__":
    sys.exit(main())
