"""Soak test: repeats a script for minutes, with firmware and both hands as processes, and checks for changes over time.

Between two rounds the hands let go and the thread is reset. Checked: every tick is recorded, the schedule is exact to
the nanosecond, and after its start the firmware has no page fault and does not grow. Each late tick is listed with its
cause. Wall time is printed but not judged, since the machine may be shared.

A tick that was charged too much CPU time either worked for too long or was robbed: some kernels charge a thread for time
that a hypervisor or an interrupt took. A witness (witness.cpp) tells them apart: it does the same short work in every
period, so what it is charged beyond that is the machine's doing. Ticks that worked for too long are an error when there
are more of them than the witness explains.

With --disk another process writes to the recorder's disk all the time, 512 MB after 512 MB, each synced at its end.

Exit: 0; 2 for bad usage; 3 when a check failed.
"""

import argparse
import math
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

ROOT = pathlib.Path(os.environ["LIGATURE_SOURCE"])
BIN = pathlib.Path(os.environ.get("LIGATURE_BIN", ROOT / "build/release/bin"))
PAUSE_S, RESET_AFTER_S = 3.0, 1.5  # between two rounds; the thread is reset during the pause
PERIOD_NS = 1_000_000
HEADER_BYTES = 65536
SETTLED_S = 5.0
LOST, MISSED, OVERWORKED, THREAD_LATE = 1, 2, 128, 256
BUS_NS = 460_000  # time for SYNC and TPDOs
WITNESS_US, WITNESS_LIMIT_US = 40, 255  # as much as a tick of the loop usually computes, and what the bus leaves to it
SURE = 0.025  # a chance below which the witness does not explain the loop's long ticks

NUMPY = {"double": ">f8", "float": ">f4", "int8_t": "i1", "int16_t": ">i2", "int32_t": ">i4", "int64_t": ">i8"}


def record_layout(slot_bytes):
    """Layout of a flight recorder slot: its head (protocol/recorder/flight_file.hpp), then tick_t as packed by LCM."""
    text = (ROOT / "protocol/lcm/tick_t.lcm").read_text()
    fields = re.findall(r"^  (double|float|int\d+_t)\s+(\w+)((?:\[\d+\])*);", text, re.M)
    head = np.dtype([("sequence", "<u8"), ("bytes", "<u4"), ("crc", "<u4")])
    body = np.dtype([(name, NUMPY[kind], tuple(map(int, re.findall(r"\d+", size)))) for kind, name, size in fields])
    offsets = [head.fields[n][1] for n in head.names] + [head.itemsize + body.fields[n][1] for n in body.names]
    formats = [head[n] for n in head.names] + [body[n] for n in body.names]
    return np.dtype({"names": [*head.names, *body.names], "formats": formats, "offsets": offsets, "itemsize": slot_bytes}), body.itemsize


class Changes(threading.Thread):
    """Sends a live change of friction every two seconds; stores the times, on the schedule's clock."""

    def __init__(self, count):
        super().__init__(daemon=True)
        self.count, self.over, self.sent_ns, self.refused = count, threading.Event(), [], 0

    def run(self):
        while len(self.sent_ns) < self.count and not self.over.wait(2.0):
            self.sent_ns.append(time.monotonic_ns())
            value = str(0.3 + 0.01 * (len(self.sent_ns) % 5))
            said = subprocess.run([BIN / "ligature-host", "send", "set", "contact.friction", value], capture_output=True, timeout=30)
            self.refused += said.returncode != 0

    def report(self, ticks):
        """Periods lost and late within one second after each change, compared with the second after that."""
        say(f"{len(self.sent_ns)} live changes, {self.refused} refused")
        for what, flag in (("lost", LOST), ("late", MISSED)):
            at = ticks["scheduled_ns"][ticks["flags"] & flag != 0]
            after = [sum(int(np.sum((at >= t + d) & (at < t + d + 10**9))) for t in self.sent_ns) for d in (0, 10**9)]
            say(f"periods {what}: {after[0]} in the seconds with a change, {after[1]} in as many without")


def script_in_a_loop(script, folder, length_s):
    """@return the file with the script repeated for that time, the number of rounds and the length of one."""
    lines = [line for line in script.read_text().splitlines() if line and not line.startswith("#")]
    heads = [line for line in lines if not line[0].isdigit()]  # interpolation and column names
    keys = [line.split(",") for line in lines if line[0].isdigit()]
    round_s = np.ceil(float(keys[-1][0])) + PAUSE_S
    rounds = max(1, int(np.ceil(length_s / round_s)))
    with open(folder / "loop.csv", "w") as out:
        out.write("\n".join(heads) + "\n")
        for i in range(rounds):
            for t, *rest in keys:
                out.write(",".join([f"{float(t) + i * round_s:.3f}", *rest]) + "\n")
    return folder / "loop.csv", rounds, round_s


class Firmware:
    """What Linux reports about the process and its real-time thread."""

    def __init__(self, pid):
        self.pid = pid
        self.loop = next((t for t in os.listdir(f"/proc/{pid}/task") if os.sched_getscheduler(int(t)) == os.SCHED_FIFO), str(pid))

    def faults(self):
        """(minor, major) page faults of the real-time thread."""
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
        _, _, slot, slots = struct.unpack("<8sIIq", opened.read(24))
        opened.seek(HEADER_BYTES)
        _, told_bytes = struct.unpack("<QI", opened.read(12))
    layout, tick_bytes = record_layout(slot)
    assert tick_bytes == told_bytes, f"a tick has {told_bytes} bytes in the recorder, {tick_bytes} in tick_t.lcm"
    raw = np.fromfile(file, dtype=layout, offset=HEADER_BYTES, count=slots)  # scenes follow after the slots
    raw = raw[raw["sequence"] > 0]
    return raw[np.argsort(raw["sequence"])]


def chance(long, witnessed, share):
    """Chance of so many long ticks or more by the machine alone: each of long + witnessed disturbances hits the loop
    with the probability `share`, its share of the computing time."""
    n = long + witnessed
    return sum(math.comb(n, k) * share**k * (1 - share) ** (n - k) for k in range(long, n + 1))


def judge_by_witness(long, computed_ns, told):
    """@param long  ticks that were charged too much CPU time; computed_ns: time that all ticks computed
    @param told  line that the witness printed. @return the error, or None."""
    periods, least_us, median_us, worst_us, over = (float(word) for word in told.split())
    say(f"witness: {periods:.0f} periods of the same work, charged {least_us:.1f} us at least, median {median_us:.1f}, worst {worst_us:.1f}; "
        f"{over:.0f} above {WITNESS_LIMIT_US} us")
    share = computed_ns / (computed_ns + 1e3 * least_us * periods)
    explained = chance(long, int(over), share)
    if long == 0 or explained >= SURE:
        return None
    return f"{long} ticks worked for too long, {over:.0f} of the witness: by the machine alone with a chance of {explained:.1e}"


def quantiles(values_ns):
    us = np.sort(values_ns.astype(float)) / 1e3
    at = [us[min(len(us) - 1, int(q * len(us)))] for q in (0.5, 0.99, 0.999, 0.9999)]
    return "  ".join(f"{v:9.1f}" for v in (*at, us[-1]))


def say(line):
    print(f"soak: {line}", flush=True)


def judge(ticks, before, after):
    """@return the errors found."""
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
    """@return the number of late ticks by cause: woke up late, waited for a hand, or did not get the CPU. Counted
    separately: ticks whose own CPU time, from the samples to the end, exceeds what the bus leaves of a period; only
    these are due to the program."""
    names = {"woke up late": 0, "waited for a hand": 0, "were kept from computing": 0, "worked for too long": 0}
    told = []
    for tick, waited, took in zip(done, waiting, computing):
        if tick["flags"] & OVERWORKED:
            name = "worked for too long"
            told.append((took, f"tick {tick['tick']}: {tick['contacts']} contacts, computing took {took / 1e3:.0f} us by the wall"))
        elif not tick["flags"] & MISSED:
            continue
        else:
            lost_ns = {"woke up late": tick["wakeup_latency_ns"], "waited for a hand": waited - BUS_NS, "were kept from computing": took}
            name = max(lost_ns, key=lost_ns.get)
        names[name] += 1
    for _, line in sorted(told)[-5:]:
        say(line)
    return names


def report(ticks):
    """@return the number of ticks that computed for longer than the time available, and the time that all computed."""
    lost = ticks["flags"] & LOST != 0
    done = ticks[~lost]
    waiting = done["tpdo_ns"] - done["sync_ns"]
    computing = done["execution_ns"] - waiting
    late = done["flags"] & MISSED != 0
    say(f"{len(ticks)} periods, {len(done)} executed ({100 * len(done) / len(ticks):.3f} %), {late.sum()} finished late, {lost.sum()} lost")
    say("us                       p50        p99      p99.9     p99.99      worst")
    for name, values in (("wake-up", done["wakeup_latency_ns"]), ("waiting for the hands", waiting), ("computing", computing), ("whole tick", done["execution_ns"])):
        say(f"{name:22}{quantiles(values)}")
    names = causes(done, waiting, computing)
    say("late ticks: " + ", ".join(f"{n} {name}" for name, n in names.items()))
    p999 = np.sort(computing)[int(0.999 * len(computing))]
    say(f"computing, p99.9: {p999 / PERIOD_NS * 100:.1f} % of the period (bar 40 %)")
    in_time = done[done["flags"] & THREAD_LATE == 0]
    ends = {name: int(np.sum(in_time["thread_end"] == value)) for name, value in (("work", 1), ("the clock", 2))}
    say(f"thread: {100 * float(np.mean(in_time['time_lost'])):.3f} % of its time lost, ticks ended by "
        + ", by ".join(f"{name} {n}" for name, n in ends.items()) + f", late {len(done) - len(in_time)}; most contacts {done['contacts'].max()}")
    return names["worked for too long"], float(np.sum(computing))


def arguments():
    parser = argparse.ArgumentParser(prog="soak", description=__doc__.splitlines()[0])
    parser.add_argument("minutes", nargs="?", type=float, default=10.0, help="10 when nothing is said; whole rounds of the script")
    parser.add_argument("--scene", default="scenes/paper.toml", help="default: %(default)s")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the scene; may be given again")
    parser.add_argument("--operator", default="scenes/operators/overhand.csv", metavar="SCRIPT",
                        help="default: %(default)s; for the scenes of a suture: scenes/operators/suture-overhand.csv")
    parser.add_argument("--disk", action="store_true", help="keep the recorder's disk busy meanwhile")
    parser.add_argument("--changes", type=int, default=0, metavar="N", help="send so many live changes of friction, one every two seconds")
    asked = parser.parse_args()
    for file in (asked.scene, asked.operator):
        if not (ROOT / file).is_file():
            parser.error(f"no file {file}")
    return asked


def ended_early(folder):
    """Prints what the devices and the firmware said before the firmware ended. Returns the exit code."""
    say("the firmware ended before its time; the programs said:")
    print("".join((folder / f"{number}.log").read_text() for number in range(3)))
    return 3


def main():
    asked = arguments()
    with tempfile.TemporaryDirectory(prefix="soak-") as name:
        folder = pathlib.Path(name)
        loop, rounds, round_s = script_in_a_loop(ROOT / asked.operator, folder, asked.minutes * 60)
        started = []
        disk, changes = DiskLoad(folder), Changes(asked.changes)

        def start(program, *args):
            with open(folder / f"{len(started)}.log", "w") as log:
                started.append(subprocess.Popen([BIN / program, *map(str, args)], cwd=ROOT, stdout=log, stderr=log))
            return started[-1]

        try:
            buses = {hand: f"local:{folder / hand}" for hand in ("left", "right")}
            for hand, bus in buses.items():
                start("ligature-device", "--rt", "--hand", hand, "--bus", bus, "--scene", asked.scene, "--operator", loop)
            length_s = rounds * round_s
            firmware = start("ligature-firmware", "run", "--scene", asked.scene, "--left", buses["left"], "--right", buses["right"],
                             "--arm", "--duration", length_s, "--watchdog-ms", 1000, "--recorder", folder / "flight.rec",
                             "--recorder-s", int(length_s) + 30, *(word for one in asked.set for word in ("--set", one)))
            say(f"{rounds} rounds, {length_s:.0f} s; load {os.getloadavg()[0]:.1f}")
            time.sleep(SETTLED_S)
            if firmware.poll() is not None:
                return ended_early(folder)
            began = time.monotonic() - SETTLED_S
            witness = subprocess.Popen([BIN / "soak_witness", str(length_s - SETTLED_S), str(WITNESS_US), str(WITNESS_LIMIT_US)],
                                       stdout=subprocess.PIPE, text=True)
            started.append(witness)
            linux = Firmware(firmware.pid)
            if asked.disk:
                disk.start()
            changes.start()
            before = {"faults": linux.faults(), "memory": linux.memory_kB()}
            for i in range(rounds):
                while firmware.poll() is None and time.monotonic() < began + (i + 1) * round_s - RESET_AFTER_S:
                    time.sleep(0.2)
                    if time.monotonic() < began + length_s - 3:
                        after = {"faults": linux.faults(), "memory": linux.memory_kB(), "cpu_s": linux.cpu_s()}
                if i + 1 < rounds:
                    if firmware.poll() is not None:
                        return ended_early(folder)
                    subprocess.run([BIN / "ligature-host", "send", "reset-thread"], capture_output=True, timeout=30)
                    say(f"round {i + 1} of {rounds}, memory {after['memory']['VmRSS']} kB, page faults {after['faults']}, load {os.getloadavg()[0]:.1f}")
            code = firmware.wait(timeout=120)
            say(f"firmware: exit {code}, loop used {after['cpu_s']:.1f} s of CPU; load {os.getloadavg()[0]:.1f}")
            print((folder / "2.log").read_text())
            ticks = ticks_of(folder / "flight.rec")
            if asked.changes:  # memory grows with the first changes and then stays; printed, not judged
                say(f"memory {before['memory']['VmRSS']} -> {after['memory']['VmRSS']} kB")
                after["memory"] = before["memory"]
            wrong = judge(ticks, before, after)
            long, computed_ns = report(ticks)
            told = witness.communicate(timeout=60)[0]
            error = judge_by_witness(long, computed_ns, told) if witness.returncode == 0 else "the witness did not run"
            if error:
                wrong.append(error)
            if asked.changes:
                changes.report(ticks)
            if asked.disk:
                say(f"beside it {disk.written_MB} MB were written to the same disk")
        finally:
            for load in (disk, changes):
                load.over.set()
                if load.is_alive():
                    load.join()
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
