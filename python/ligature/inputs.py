"""What goes in: scenes, scripts of hands, polylines."""

import os
from collections.abc import Iterable, Mapping
from typing import Any, Self

import numpy as np

from ligature import _core

Path = str | os.PathLike[str]
Overrides = Mapping[str, Any] | Iterable[str]


def numbers(value: Any, name: str) -> np.ndarray:
    """`value` as doubles in rows, or a Refusal that names it."""
    try:
        with np.errstate(all="ignore"):
            array = np.asarray(value)
            if array.dtype.kind in "biuf":
                return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise _core.Refusal(f"{name}: found no array of numbers, allowed rows of equally many") from None
    raise _core.Refusal(f"{name}: found an array of {array.dtype}, allowed numbers")


def number(value: Any, name: str) -> float:
    """`value` as a double, or a Refusal that names it."""
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise _core.Refusal(f"{name}: found {type(value).__name__}, allowed a number") from None


def path_of(path: Path) -> str:
    """A path as text. What no file can be called is refused."""
    text = os.fspath(path)
    if not isinstance(text, str) or "\0" in text or any("\ud800" <= c <= "\udfff" for c in text):
        raise _core.Refusal("path: found what is no text in UTF-8, or a null character; allowed a text without")
    return text


def toml_of(value: Any) -> str:
    """A value as TOML writes it. A text stays as it is: the scene's reader takes it with quotes and without."""
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
    """A text inside a list or a table needs its quotes."""
    if not isinstance(value, str):
        return toml_of(value)
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'


def lines_of(overrides: Overrides | None) -> list[str]:
    """["suture.nodes=35"] from a mapping or from such lines."""
    if overrides is None:
        return []
    if isinstance(overrides, Mapping):
        return [f"{key}={toml_of(value)}" for key, value in overrides.items()]
    if isinstance(overrides, str):
        return [overrides]
    return [str(line) for line in overrides]


class Scene(_core.Scene):
    """A scene file, read and checked. Its numbers are read by the programs' own reader (protocol/scene/scene_file.hpp)."""

    @classmethod
    def load(cls, path: Path, overrides: Overrides | None = None) -> Self:
        """Reads a scene file (TOML), strictly, and the overrides on top of it.

        overrides: {"suture.nodes": 35, "contact.friction": 0.2}, or lines "suture.nodes=35" as --set takes them.
        Raises Refusal with the line that the programs print: file and line, key, what was found, what is allowed.
        """
        return cls(path_of(path), lines_of(overrides))

    @classmethod
    def parse(cls, text: str, overrides: Overrides | None = None, path: Path = "scene.toml") -> Self:
        """The same from a text. path: what messages call it, and where a polyline that it names is looked for."""
        return cls(path_of(path), lines_of(overrides), text)


class Script(_core.Script):
    """What two hands do over time. Between keys a hand moves by 3u^2 - 2u^3: every key is a rest point."""

    @classmethod
    def load(cls, path: Path) -> Self:
        """Reads a gripper script (CSV: time,hand,x,y,z,grip). Raises Refusal with file, line and column."""
        return cls(path_of(path))

    @classmethod
    def of_keys(cls, left: Any = (), right: Any = ()) -> Self:
        """From arrays, one row a key: time s, x, y, z m, grip 0 or 1; and three turns in degrees where tools turn.

        Times rise from 0 on, at most 1e6. A hand without rows is absent. Raises Refusal with row and column.
        """
        script = cls()
        script._add_keys(0, numbers(left, "left"))
        script._add_keys(1, numbers(right, "right"))
        return script


def knot(points: Any, closed: bool = False) -> _core.Knot:
    """Names the knot in a polyline: type, handedness, determinant, Alexander polynomial.

    points: n x 3, m, in order along the thread, at most 20000. closed: the last point is joined to the first; else the
    thread is open and is closed in several ways, of which most must agree. About 1 ms for 500 points.
    Raises Refusal for another shape, or a coordinate that is no number or beyond 1e9. Source: host/knot/recognise.hpp.
    """
    return _core.knot(numbers(points, "points"), bool(closed))
