"""What one run gets: arguments, overrides of its scene, and its seed; and what it leaves in its row about its scene."""

import hashlib
import pathlib
from typing import Any

from ligature import SCENES, Refusal, Scene, Simulation
from ligature.inputs import lines_of


def file_of(name: str, folder: str) -> pathlib.Path:
    """A file beside the study, else the shipped scene or script with that name. Raises Refusal."""
    for path in (pathlib.Path(folder) / name, SCENES / name):
        if path.is_file():
            return path
    raise Refusal(f"{name}: found no such file in {folder}, nor a shipped one; allowed: a file of the study's folder")


def divided(values: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Arguments of a task, and overrides of a scene, whose names have a dot."""
    return ({name: value for name, value in values.items() if "." not in name},
            {name: value for name, value in values.items() if "." in name})


class Job:
    """One run of a study, as a task sees it."""

    def __init__(self, arguments: dict[str, Any], overrides: dict[str, Any], seed: int, folder: str) -> None:
        self.arguments = arguments
        self.overrides = overrides
        self.seed = seed
        self.folder = folder
        self.scene_hash = ""
        self.budget = 0

    def file(self, argument: str) -> pathlib.Path:
        """The file that an argument names."""
        return file_of(self.arguments[argument], self.folder)

    def scene(self) -> Scene:
        """The scene of this run, with its overrides."""
        path = self.file("scene")
        scene = Scene.load(path, self.overrides)
        self.hash_of(path)
        return scene

    def simulation(self, scene: Scene) -> Simulation:
        """A simulation of the scene; its start shape and its budget enter the row."""
        made = Simulation(scene)
        self.hash_of(self.file("scene"), made.nodes.tobytes())
        self.budget = made.budget
        return made

    def hash_of(self, path: pathlib.Path, more: bytes = b"") -> None:
        """Sets the hash: of the file's bytes, the overrides, and `more`."""
        lines = "\n".join(sorted(lines_of(self.overrides)))
        self.scene_hash = hashlib.sha256(path.read_bytes() + b"\0" + lines.encode() + b"\0" + more).hexdigest()[:16]
