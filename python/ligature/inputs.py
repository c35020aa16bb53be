"""Inputs of a simulation: scenes, scripts of the hands, polylines."""

import os
from collections.abc import Iterable, Mapping
from typing import Any, Self

import numpy as np

from ligature import _core

Path = str | os.PathLike[str]
Overrides = Mapping[str, Any] | Iterable[str]


def numbers(value: Any, name: str) -> np.ndarray:
    """`value` as an array of doubles. Raises Refusal with `name` in the message."""
    try:
        with np.errstate(all="ignore"):
            array = np.asarray(value)
            if array.dtype.kind in "biuf":
                return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise _core.Refusal(f"{name}: found no array of numbers, allowed rows of equally many") from None
    raise _core.Refusal(f"{name}: found an array of {array.dtype}, allowed numbers")


def number(value: Any, name: str) -> float:
    """`value` as a double. Raises Refusal with `name` in the message."""
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise _core.Refusal(f"{name}: found {type(value).__name__}, allowed a number") from None


def path_of(path: Path) -> str:
    """A path as text. Raises Refusal for text that cannot be a file name."""
    text = os.fspath(path)
    if not isinstance(text, str) or "\0" in text or any("\ud800" <= c <= "\udfff" for c in text):
        raise _core.Refusal("path: found what is no text in UTF-8, or a null character; allowed a text without")
    return text


def toml_of(value: Any) -> str:
    """A value in TOML syntax. Text is returned unchanged: the scene reader accepts it with or without quotes."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {quoted(each)}" for key, each in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(quoted(each) for each in value) + "]"
    raise _core.Refusal(f"overrides: found a {type(value).__name__}, allowed texts, numbers, booleans, lists and tables of these")


def quoted(value: Any) -> str:
    """A value in TOML syntax, with text in quotes, as lists and tables need it."""
    if not isinstance(value, str):
        return toml_of(value)
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'


def lines_of(overrides: Overrides | None) -> list[str]:
    """Overrides as lines such as "suture.nodes=35", from a mapping or from such lines."""
    if overrides is None:
        return []
    if isinstance(overrides, Mapping):
        return [f"{key}={toml_of(value)}" for key, value in overrides.items()]
    if isinstance(overrides, str):
        return [overrides]
    return [str(line) for line in overrides]


class Scene(_core.Scene):
    """A scene, read and checked by the same reader as in the programs (protocol/scene/scene_file.hpp)."""

    source: tuple[str, str | None, list[str]] | None = None  # path, text unless it is that file's, overrides

    @classmethod
    def load(cls, path: Path, overrides: Overrides | None = None) -> Self:
        """Reads a scene file (TOML; unknown keys are errors) and applies the overrides.

        overrides: {"suture.nodes": 35, "contact.friction": 0.2}, or lines such as "suture.nodes=35" (as for --set).
        Raises Refusal with the programs' message: file and line, key, what was found, what is allowed.
        """
        return cls._made(path_of(path), None, lines_of(overrides))

    @classmethod
    def parse(cls, text: str, overrides: Overrides | None = None, path: Path = "scene.toml") -> Self:
        """As load(), from a text. path: file name for messages; a polyline file of the scene is searched beside it."""
        return cls._made(path_of(path), text, lines_of(overrides))

    @classmethod
    def _made(cls, path: str, text: str | None, overrides: list[str]) -> Self:
        made = cls(path, overrides, text)
        made.source = (path, text, overrides)
        return made

    def source_file(self, folder: os.PathLike[str]) -> tuple[str, list[str]]:
        """A file for a program's --scene, written into `folder` if this scene is a text, and overrides for --set."""
        if self.source is None:
            raise _core.Refusal(f"{self.path}: found a scene without a file, allowed one of Scene.load or Scene.parse")
        path, text, overrides = self.source
        if text is None:
            return os.path.abspath(path), overrides
        file = os.path.join(folder, os.path.basename(path) or "scene.toml")
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
        return file, overrides


class Script(_core.Script):
    """Motion of the two hands over time. Between keys a hand moves by 3u^2 - 2u^3, so it is at rest at every key."""

    @classmethod
    def load(cls, path: Path) -> Self:
        """Reads a gripper script (CSV: time,hand,x,y,z,grip). Raises Refusal with file, line and column."""
        return cls(path_of(path))

    @classmethod
    def of_keys(cls, left: Any = (), right: Any = ()) -> Self:
        """Makes a script from arrays, one row per key: time s, x, y, z m, grip 0 or 1, and optionally three rotation
        angles of the tool in degrees.

        Times rise from 0 to at most 1e6. A hand without rows is absent. Raises Refusal with row and column.
        """
        script = cls()
        script._add_keys(0, numbers(left, "left"))
        script._add_keys(1, numbers(right, "right"))
        return script


def knot(points: Any, closed: bool = False) -> _core.Knot:
    """Names the knot in a polyline: type, handedness, determinant, Alexander polynomial.

    points: n x 3, m, in order along the thread, at most 20000. closed: the last point is joined to the first. An open
    thread is closed in several ways, and the majority of the results decides. About 1 ms for 500 points.
    Raises Refusal for another shape, or a coordinate that is not finite or beyond 1e9. Source: host/knot/recognise.hpp.
    """
    return _core.knot(numbers(points, "points"), bool(closed))
