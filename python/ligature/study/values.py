"""Checks of single values in a study file, with one-line refusals that name file, key, what was found and what is allowed."""

import math
from typing import Any, NamedTuple

from ligature._core import Refusal


class Place(NamedTuple):
    """Where a value stands: a file and a key."""

    file: str
    key: str

    def refuse(self, found: Any, allowed: str) -> Refusal:
        """The refusal to raise."""
        text = found if isinstance(found, str) and found.startswith("no ") else repr(found)
        return Refusal(f"{self.file}: key '{self.key}': found {text[:80]}, allowed {allowed}")

    def of(self, key: str) -> "Place":
        """The place of a key within this table."""
        return Place(self.file, f"{self.key}.{key}" if self.key else key)


class Number(NamedTuple):
    """A number from `low` to `high`; `whole`: an integer."""

    low: float = -math.inf
    high: float = math.inf
    whole: bool = False

    def check(self, place: Place, value: Any) -> float | int:
        """The value as a number. Raises Refusal."""
        kinds = (int,) if self.whole else (int, float)
        if isinstance(value, bool) or not isinstance(value, kinds) or not self.low <= value <= self.high or math.isinf(value):
            raise place.refuse(value, f"{'an integer' if self.whole else 'a number'} {self.low:g} .. {self.high:g}")
        return value


class Text(NamedTuple):
    """A text; `one_of`: one of these, if there are any."""

    one_of: tuple[str, ...] = ()

    def check(self, place: Place, value: Any) -> str:
        """The value as a text. Raises Refusal."""
        if not isinstance(value, str) or not value or (self.one_of and value not in self.one_of):
            raise place.refuse(value, f"one of {', '.join(self.one_of)}" if self.one_of else "a text")
        return value


class Flag(NamedTuple):
    """True or false."""

    def check(self, place: Place, value: Any) -> bool:
        """The value. Raises Refusal."""
        if not isinstance(value, bool):
            raise place.refuse(value, "true or false")
        return value


Kind = Number | Text | Flag


def table(place: Place, value: Any) -> dict[str, Any]:
    """The value as a table. Raises Refusal."""
    if not isinstance(value, dict):
        raise place.refuse(value, "a table")
    return value


def no_others(place: Place, found: dict[str, Any], allowed: tuple[str, ...]) -> None:
    """Raises Refusal when a table has other keys than these."""
    for key in found:
        if key not in allowed:
            raise place.of(key).refuse("no such key", ", ".join(allowed))


def flat(found: dict[str, Any]) -> dict[str, Any]:
    """Keys of a scene by their full names: TOML reads `contact.friction = 0.3` as a table `contact`."""
    flattened: dict[str, Any] = {}
    for name, value in found.items():
        inner = isinstance(value, dict) and name in ("suture", "contact", "world", "time", "hands")
        flattened.update({f"{name}.{key}": each for key, each in value.items()} if inner else {name: value})
    return flattened
