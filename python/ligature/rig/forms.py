"""Which form of rig a test gets, and what every form can do."""

import os
import pathlib
import shutil
from typing import Protocol

import numpy as np

from ligature import Refusal, _core
from ligature.inputs import Path, Scene, path_of

Columns = dict[str, np.ndarray]
FORMS = ("virtual", "live", "real")


class Expected(AssertionError):
    """Raised if something that a test waited for did not happen in time."""


class Connection(Protocol):
    """One form of rig. Periods are those of the controller, 1 ms each."""

    dry: bool  # no force is possible

    def start(self) -> None: ...
    def close(self) -> None: ...
    def latest(self) -> Columns: ...  # one row of ligature.TICK_COLUMNS; empty arrays before the first tick
    def ticks(self) -> Columns: ...  # all rows so far
    def nodes(self) -> np.ndarray: ...  # n x 3, m: the newest shape
    def pass_periods(self, periods: int) -> None: ...
    def command(self, word: str) -> None: ...
    def wish(self, hand: int, place: tuple[float, float, float], dead_man: bool, grip: bool) -> None: ...


_chosen = {"form": "virtual", "bin": None, "firmware": []}


def use(form: str, bin: Path | None = None, firmware: list[str] | None = None) -> None:
    """Selects what Rig is from now on: "virtual", "live" or "real". pytest does it by --ligature-rig.

    bin: folder of the programs, for live; None: those of PATH. firmware: further options of `ligature-firmware run`.
    """
    if form not in FORMS:
        raise Refusal(f"form: found {form!r}, allowed {', '.join(FORMS)}")
    _chosen.update(form=form, bin=bin, firmware=list(firmware or []))


def form() -> str:
    """The selected form."""
    return str(_chosen["form"])


def firmware_options() -> list[str]:
    return list(_chosen["firmware"])  # type: ignore[arg-type]


def program(name: str) -> str:
    """Path of one of the project's programs. Raises Refusal when it is not found."""
    folder = _chosen["bin"]
    found = shutil.which(name, path=None if folder is None else os.fspath(folder))  # type: ignore[arg-type]
    if found is None:
        raise Refusal(f"{name}: not found in {folder or 'PATH'}; allowed: --ligature-bin FOLDER with the built programs")
    return found


def fault_files(faults: list[Path] | tuple[Path, ...] | Path) -> dict[int, str]:
    """The file of each hand's fault script. Raises Refusal for a wrong file, and for two of one hand."""
    files: dict[int, str] = {}
    for path in [faults] if isinstance(faults, (str, os.PathLike)) else faults:
        file = path_of(path)
        hand = _core._fault_hand(file)
        if hand in files:
            raise Refusal(f"{file}: found a second fault for the {('left', 'right')[hand]} hand, allowed one for each")
        files[hand] = file
    return files


def scene_of(scene: Scene | Path) -> Scene:
    """A scene, or the shipped or own file with that name."""
    if isinstance(scene, _core.Scene):
        return scene  # type: ignore[return-value]
    from ligature import SCENES

    path = pathlib.Path(path_of(scene))
    return Scene.load(path if path.exists() or path.is_absolute() else SCENES / path)
