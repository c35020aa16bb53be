"""Faults of a rig that renders force in the guest, and the required reaction, exact to the tick. Every executed tick
sends one SYNC, so counting SYNCs gives the tick numbers on the bus."""

import subprocess

import cantools

from scenario import ENGAGE, FAULT, FORCE, IDLE, LOST, MISSED, Scenario, program, pushes, ticks_of, wire_of

WATCHDOG_TICKS = 20
ERROR_FRAME, BUS_OFF = 0x20000000, 0x20000040  # linux/can/error.h


class Blows(Scenario):
    """Each fault occurs while the rig renders force; `at` is the first tick that can see it. The first line of a test's
    docstring, with the stated and the observed reaction, is a row of docs/measurements/fault-matrix-guest.md."""

    def row(self, stated, seen):
        self.rows[self._testMethodName] = (self._testMethodDoc.strip().splitlines()[0].rstrip("."), stated, seen)
        print(f"  {self._testMethodName[5:]}: {seen}; stated: {stated}", flush=True)

    def read(self, name, ours="vcan0", other="vcan1"):
        """@param ours, other the controller's left and right interfaces."""
        folder = self.of_run = self.folder / name
        wire = wire_of(folder)
        left = [f for f in wire if f[0] == ours]
        right = [f for f in wire if f[0] == other]
        rows = ticks_of(folder)
        self.every_tick_is_there(rows)
        return rows, left, right

    @staticmethod
    def tick_before(rows, frames, position):
        """The tick during which frame number `position` was on the bus. Lost periods send no SYNC."""
        executed = [r["tick"] for r in rows if not r["flags"] & LOST]
        return executed[sum(f[1] == 0x080 for f in frames[:position + 1]) - 1]

    @staticmethod
    def sync_of(rows, frames, tick, interface):
        """Index in `frames` of a tick's SYNC on an interface; every executed tick must have sent one there."""
        executed = [r["tick"] for r in rows if not r["flags"] & LOST]
        return [i for i, f in enumerate(frames) if f[0] == interface and f[1] == 0x080][executed.index(tick)]

    @staticmethod
    def position(frames, identifier, data=None):
        return next(i for i, f in enumerate(frames) if f[1] == identifier and (data is None or f[2] == data))

    def torque_on_the_wire(self, rows, frames, first_tick):
        """Target torques of all RPDOs that were sent from tick `first_tick` on."""
        executed = [r["tick"] for r in rows if not r["flags"] & LOST]
        syncs, seen = 0, []
        for _, identifier, data in frames:
            syncs += identifier == 0x080
            if syncs and executed[syncs - 1] >= first_tick and 0x201 <= identifier <= 0x203:
                seen.append(int.from_bytes(data[2:4], "little", signed=True))
        return seen

    def ends_in(self, faults, rows, left, right, at, within, besides=""):
        """Expects one of `faults` within the ticks `within` after `at`, and from then on no torque of either hand in
        any record or frame. `besides`: text for the page's row: why the reaction may take longer in this run."""
        before = rows[at - 2]
        self.assertEqual((before["state"], pushes(before)), (FORCE, True), "the blow must find the rig in force")
        first = next(r for r in rows if r["fault"] != 0)
        last = f"{within[-1]}" if not besides else f"{WATCHDOG_TICKS}{besides}"
        self.row(f"fault {' or '.join(map(str, faults))}, tick +{within[0]} .. +{last}, both hands, until a reset",
                 f"fault {first['fault']}, tick +{first['tick'] - at}")
        self.assertIn(first["fault"], faults)
        self.assertIn(first["tick"] - at, within)
        for row in rows[first["tick"]:]:
            self.assertEqual((row["fault"], row["state"], pushes(row)), (first["fault"], FAULT, False))
        saved, = self.of_run.glob(f"*.fault-{first['fault']}.1")
        self.assertEqual([r["tick"] for r in ticks_of(self.of_run, saved.name)], list(range(max(0, first["tick"] - 1999), first["tick"] + 1)),
                         "two seconds of ticks up to the fault, in a file of their own")
        for frames in (left, right):
            self.assertEqual(set(self.torque_on_the_wire(rows, frames, first["tick"])) - {0}, set(), "torque on the wire after the fault")


class FirstBlows:
    def test_a_killed_hand(self):
        """A hand is killed (SIGKILL).
        The watchdog's time starts at its last complete set of samples."""
        rows, left, right = self.read("hand-killed")
        last = max(i for i, f in enumerate(left) if 0x181 <= f[1] <= 0x183)
        at = self.tick_before(rows, left, last)
        # While the kernel kills the process, the guest's only CPU is busy, and the controller loses some periods.
        lost = sum(r["flags"] & LOST != 0 for r in rows[at:at + WATCHDOG_TICKS])
        self.ends_in((11,), rows, left, right, at, range(WATCHDOG_TICKS - 1, WATCHDOG_TICKS + lost + 1),
                     " and the periods that the one CPU needs for the killing")
        first = next(r for r in rows if r["fault"] != 0)
        self.assertEqual(first["left_tpdo_age_ticks"], WATCHDOG_TICKS)

    def test_an_emergency_of_a_drive(self):
        """EMCY of a drive."""
        rows, left, right = self.read("emergency")
        at = self.tick_before(rows, left, self.position(left, 0x082, bytes.fromhex("5082110000000000")))
        self.ends_in((12,), rows, left, right, at, (0, 1))

    def test_bus_off(self):
        """Bus-off, reported by an error frame of the driver (vcan).
        In bus-off no further SYNC can be sent."""
        rows, left, right = self.read("bus-off")
        last = max(i for i, f in enumerate(left) if f[1] == 0x080)
        self.ends_in((10,), rows, left, right, self.tick_before(rows, left, last), (0, 1))

    def test_candump_decodes_fully(self):
        dbc = cantools.database.load_string(subprocess.run([*program("ligature-can-describe"), "dbc"], capture_output=True, text=True, check=True).stdout, "dbc")
        counts = {}
        for _, identifier, data in wire_of(self.folder / "hand-killed"):
            message = dbc.get_message_by_frame_id(identifier)
            message.decode(data, allow_truncated=False, allow_excess=False)
            counts[message.name] = counts.get(message.name, 0) + 1
        print("  " + ", ".join(f"{n} {name}" for name, n in sorted(counts.items())), flush=True)
        for name in ("Sync", "Nmt", "Controller_Heartbeat", *(f"{d}_{s}" for d in ("Waist", "Shoulder", "Elbow")
                                                              for s in ("TPDO1", "RPDO1", "SdoRequest", "SdoResponse", "Heartbeat", "Emergency"))):
            self.assertGreater(counts.get(name, 0), 0, name)


class OtherBlows:
    def test_somebody_else_stops_a_drive(self):
        """A foreign NMT command stops a drive.
        That drive's torque ends at once; the controller receives the NMT command, too, and reports a fault."""
        rows, left, right = self.read("stranger")
        at = self.tick_before(rows, left, self.position(left, 0x000, bytes.fromhex("8002")))
        self.ends_in((15,), rows, left, right, at, (0, 1))

    def test_somebody_else_commands_torque(self):
        """A foreign RPDO commands 3000 per mille.
        The controller's own RPDO of that period follows; from the fault on NMT stops the drives."""
        rows, left, right = self.read("foreign-rpdo")
        alien = self.position(left, 0x201, bytes.fromhex("0f00b80b"))
        at = self.tick_before(rows, left, alien)
        self.ends_in((13,), rows, left[:alien] + left[alien + 1:], right, at, (0, 1))
        first = next(r["tick"] for r in rows if r["fault"] != 0)
        for frames in (left, right):
            ends = [f for f in frames if f[1] == 0x000 and f[2] == bytes.fromhex("0200")]
            self.assertGreaterEqual(len(ends), sum(r["tick"] > first and not r["flags"] & LOST for r in rows), "NMT stop in every period")

    def test_a_stopped_controller(self):
        """SIGSTOP of the controller for 0.1 s, SIGCONT.
        The drives remove the torque by themselves; the controller, when continued, has an overrun fault."""
        rows, left, right = self.read("controller-stopped")
        for frames in (left, right):
            told = [f for f in frames if 0x081 <= f[1] <= 0x083 and f[2][:2] == bytes.fromhex("5082")]
            self.assertEqual({f[1] for f in told}, {0x081, 0x082, 0x083}, "EMCY 0x8250: no RPDO for 20 ms")
        lost = [r["tick"] for r in rows if r["flags"] & LOST]
        first = next(r for r in rows[lost[0]:] if not r["flags"] & LOST)
        slept = first["tick"] - lost[0]
        self.assertGreater(slept, 90)
        # The signal may come late in a period. The tick of that period then ends late, and the next periods are lost, too.
        self.assertLessEqual(set(lost[slept:]), {first["tick"] + 1, first["tick"] + 2})
        self.assertIn(first["fault"], (12, 30), "what it finds first: its drives in fault, or its own sleep")
        self.assertEqual(first["state"], FAULT)
        self.assertTrue(pushes(rows[lost[0] - 3]))
        self.assertFalse(any(pushes(r) for r in rows[first["tick"]:]))
        self.row("every drive sends EMCY 0x8250 and removes its torque by itself; fault 12 or 30 in the first executed tick",
                 f"fault {first['fault']}, {slept} periods lost before it")

    def test_the_clock_on_the_wall_does_not_matter(self):
        """Wall clock +1 day, then -2 days."""
        rows, _, _ = self.read("clock-step")
        self.assertEqual({r["fault"] for r in rows}, {0})
        self.assertEqual(sum(r["flags"] & (LOST | MISSED) != 0 for r in rows), 0)
        self.row("nothing in the loop: no fault, no period missed or lost", "nothing")

    def test_an_interface_that_goes_down_under_the_sja1000_driver(self):
        """Interface down under the SJA1000 driver.
        Its queue stops first; the loss is reported when the driver has closed it, unless the watchdog expires before."""
        rows, left, right = self.read("sja1000-pulled", "can0")
        last = max(i for i, f in enumerate(left) if f[1] == 0x080)
        self.ends_in((10, 11), rows, left, right, self.tick_before(rows, left, last), range(WATCHDOG_TICKS + 2))

    def test_force_comes_back_by_order_only(self):
        """The same interface is up again after 0.2 s; 0.5 s later `reset-fault`, 0.5 s later `arm`."""
        rows, _, _ = self.read("sja1000-pulled-and-back", "can0")
        self.comes_back_by_order(rows, 600)

    def comes_back_by_order(self, rows, at_least):
        """@return the tick in which the command to arm was executed."""
        faulted = [r["tick"] for r in rows if r["state"] == FAULT]
        self.assertGreater(len(faulted), at_least, "without a bus, then 0.5 s with one: it stays a fault")
        self.assertEqual(faulted, list(range(faulted[0], faulted[-1] + 1)))
        after = rows[faulted[-1] + 1:]
        disarmed = after[:next(i for i, r in enumerate(after) if r["state"] == ENGAGE)]
        self.assertGreater(sum(r["state"] == IDLE for r in disarmed), 300, "enabled again after the reset, but not armed")
        self.assertFalse(any(pushes(r) for r in disarmed))
        self.assertTrue(any(r["state"] == FORCE and pushes(r) for r in after), "the order to arm brings it back")
        self.row("FAULT until `reset-fault`, no torque until `arm`, then force again",
                 f"{len(faulted)} ticks in FAULT, {len(disarmed)} without torque after the reset")
        return disarmed[-1]["tick"] + 1

    def slcan(self):
        """@return of the run in which the left CAN controller goes bus-off: tick records; frames on the left interface,
        on the right one, and on all."""
        return *self.read("slcan-bus-off", "slcan0", "wire1"), wire_of(self.folder / "slcan-bus-off", by_time=True)

    def test_bus_off_of_a_controller_with_error_counters(self):
        """Bus-off of a CAN controller with error counters (slcan), reported by the state of its interface.
        The driver calls the kernel's can_bus_off()."""
        rows, left, right, wire = self.slcan()
        logs = [(self.folder / f"slcan-bus-off/slcan-{when}.log").read_text() for when in ("before", "after")]
        for log, state, flags in zip(logs, ("ERROR-ACTIVE", "BUS-OFF"), ("<NOARP,UP,LOWER_UP>", "<NO-CARRIER,NOARP,UP>"), strict=True):
            self.assertIn(f"can state {state} ", log)
            self.assertIn(flags, log)
        at = self.position(left, BUS_OFF)
        until_reset = rows[:1 + max(r["tick"] for r in rows if r["state"] == FAULT)]
        self.ends_in((10,), until_reset, left[:at], right[:self.sync_of(rows, right, len(until_reset), "wire1")], self.tick_before(rows, left, at), (0, 1))
        told = {f[1] for f in wire if f[0] == "wire0" and 0x081 <= f[1] <= 0x083 and f[2][:2] == bytes.fromhex("5082")}
        self.assertEqual(told, {0x081, 0x082, 0x083}, "EMCY 0x8250: the drives took the torque by themselves, too")

    def test_bus_off_of_such_a_controller_is_over_by_order_only(self):
        """The same CAN controller recovers on its own after 0.2 s, its interface goes down and up after 0.4 s; 0.5 s later `reset-fault`, 0.5 s later `arm`."""
        rows, left, right, wire = self.slcan()
        armed = self.comes_back_by_order(rows, 800)
        ours = left[self.position(left, BUS_OFF) + 1:]
        self.assertTrue([f for f in ours if f[1] & ERROR_FRAME], "the driver tells that it is error active again")
        self.assertGreater(sum(f[1] == 0x080 for f in ours), 800, "SYNC goes out again, and RPDOs")
        first = next(r["tick"] for r in rows if r["fault"] != 0)
        began, ended = (self.sync_of(rows, wire, tick, "wire1") for tick in (first, armed))
        torques = {int.from_bytes(f[2][2:4], "little", signed=True) for f in wire[began:ended] if 0x201 <= f[1] <= 0x203}
        self.assertEqual(torques, {0}, "on any bus, from the fault to the order")
