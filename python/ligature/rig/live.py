"""The form live: firmware and two simulated devices as processes, in real time."""

import pathlib
import subprocess
import tempfile
import time

from ligature import Refusal
from ligature.inputs import Scene
from ligature.rig.forms import Columns, Expected, firmware_options, program
from ligature.rig.hand import SIDES
from ligature.rig.network import Network

START_S, END_S = 30.0, 20.0


class Live:
    """See forms.Connection. The processes end with close(); their output is part of what Expected says."""

    dry = False

    def __init__(self, scene: Scene, faults: dict[int, str]) -> None:
        if not isinstance(scene, Scene):
            raise Refusal("scene: found one of a simulation, allowed a Scene, a path or a shipped name in the form live")
        self._scene, self._faults = scene, faults
        self._programs = {name: program(f"ligature-{name}") for name in ("firmware", "device", "host")}
        self._folder = tempfile.TemporaryDirectory(prefix="ligature-rig-")
        self._path = pathlib.Path(self._folder.name)
        self._network = Network(scene)
        self._running: dict[str, subprocess.Popen[bytes]] = {}
        self.nodes, self.wish, self.ticks = self._network.nodes, self._network.wish, self._network.ticks

    def start(self) -> None:
        try:
            self._network.start()
            path, overrides = self._scene.source_file(self._path)
            scene = ["--scene", path, *(word for line in overrides for word in ("--set", line))]
            buses = [f"local:{self._path / side}" for side in SIDES]
            for index, side in enumerate(SIDES):
                fault = ["--faults", self._faults[index]] if index in self._faults else []
                self._run(side, "device", "--hand", side, "--bus", buses[index], *scene, "--operator", "page", "--rt", *fault)
            self._run("firmware", "firmware", "run", *scene, "--left", buses[0], "--right", buses[1], "--recorder",
                      str(self._path / "flight.rec"), *firmware_options())
            self._wait_for_hands()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self._network.end()
        for process in reversed(self._running.values()):  # the firmware first, so that it ramps the forces down
            if process.poll() is None:
                process.terminate()
                try:
                    process.wait(END_S)
                except subprocess.TimeoutExpired:
                    process.kill()
            process.wait()
        self._folder.cleanup()

    def latest(self) -> Columns:
        return self._network.latest()

    def pass_periods(self, periods: int) -> None:
        try:
            self._network.pass_periods(periods)
        except Expected as nothing:
            raise Expected(f"{nothing}\n{self._words()}") from None

    def command(self, word: str) -> None:
        """Sends a command with its challenge, as `ligature-host send` does, and requires that it is accepted."""
        sent = subprocess.run([self._programs["host"], "send", word], capture_output=True, text=True, timeout=END_S, check=False)
        if sent.returncode != 0:
            raise Expected(f"expected: the command {word} accepted; {sent.stderr.strip()}")

    def _run(self, name: str, of: str, *arguments: str) -> None:
        with open(self._path / f"{name}.log", "wb") as log:
            self._running[name] = subprocess.Popen([self._programs[of], *arguments], stdout=log, stderr=log)

    def _wait_for_hands(self) -> None:
        """Until the firmware has switched both hands' drives on, so that they follow targets."""
        end_s = time.monotonic() + START_S
        while not all(hand in self._network.hands and self._network.hands[hand].is_live for hand in (0, 1)):
            ended = [name for name, process in self._running.items() if process.poll() is not None]
            if ended or time.monotonic() > end_s:
                raise Expected(f"expected: a rig that starts within {START_S:g} s; ended: {', '.join(ended) or 'nothing'}\n{self._words()}")
            time.sleep(0.02)
        for hand in (0, 1):
            self._network.take(hand)

    def _words(self) -> str:
        return "\n".join(f"--- {log.name}\n{log.read_text(errors='replace')[-2000:]}" for log in sorted(self._path.glob("*.log")))
