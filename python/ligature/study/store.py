"""Rows of a study on disk: a journal line for each run as it ends, and Parquet parts that replace the lines.

A line is written at once, so that a process that is killed loses no finished run. A part appears under its name when it
is complete. A journal that is there at the start is a leftover of a process that was killed; its part has the same rows,
if there is one.
"""

import fcntl
import json
import os
import pathlib
import time
from typing import Any, Self

import pyarrow as pa
import pyarrow.parquet as pq

from ligature._core import Refusal
from ligature.inputs import Path, path_of

PART_ROWS, PART_S = 500, 10.0  # a part is written after so many rows, or seconds


def _column(name: str, values: list[Any]) -> pa.Array:
    """Values as one Parquet column: truth values, whole numbers, numbers or texts; lists become texts."""
    there = [value for value in values if value is not None]
    if all(isinstance(value, bool) for value in there):
        return pa.array(values, pa.bool_() if there else pa.null())
    if name in ("run", "seed", "budget"):
        return pa.array(values, pa.int64())
    if all(isinstance(value, (int, float)) for value in there):
        return pa.array([None if value is None else float(value) for value in values], pa.float64())
    return pa.array([None if value is None else value if isinstance(value, str) else json.dumps(value) for value in values], pa.string())


def table_of(found: list[dict[str, Any]]) -> pa.Table:
    """Rows as a table; a value that a row lacks is null."""
    names = list(dict.fromkeys(name for row in found for name in row))
    return pa.table({name: _column(name, [row.get(name) for row in found]) for name in names})


def _write(path: pathlib.Path, content: pa.Table | str) -> None:
    """Writes a file so that it appears only when it is complete."""
    unfinished = path.with_name(f".{path.name}.unfinished")
    with open(unfinished, "wb") as file:
        if isinstance(content, str):
            file.write(content.encode())
        else:
            pq.write_table(content, file, compression="zstd")
        file.flush()
        os.fsync(file.fileno())
    os.replace(unfinished, path)


def _lines(path: pathlib.Path) -> list[dict[str, Any]]:
    """Complete lines of a journal; what a kill left of a line is not one."""
    return [json.loads(line) for line in path.read_bytes().split(b"\n")[:-1]]


class Store:
    """The folder of a study's rows; one process at a time may hold it."""

    def __init__(self, out: str, identity: dict[str, Any], text: str) -> None:
        self.folder = pathlib.Path(out)
        self.identity = json.loads(json.dumps(identity))
        self.text = text
        self.parts = self.folder / "rows"
        self._journals = self.folder / "journal"
        self._pending: list[dict[str, Any]] = []
        self._written_s = time.monotonic()

    def __enter__(self) -> Self:
        self._refuse_another_study()
        try:
            for folder in (self.folder, self.parts, self._journals):
                folder.mkdir(parents=True, exist_ok=True)
            self._lock = open(self.folder / "lock", "w")  # noqa: SIM115, held until the end
        except OSError as why:
            raise Refusal(f"{self.folder}: {why.strerror}, allowed a folder that can be written") from None
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._lock.close()
            raise Refusal(f"{self.folder}: another study is running there, allowed one at a time") from None
        _write(self.folder / "study.toml", self.text)
        _write(self.folder / "study.json", json.dumps(self.identity, indent=1) + "\n")
        for journal in sorted(self._journals.glob("*.jsonl")):
            if found := _lines(journal):
                _write(self.parts / f"{journal.stem}.parquet", table_of(found))
            journal.unlink()
        self._begin_part()
        return self

    def __exit__(self, *_: Any) -> None:
        self.flush()
        self._journal.close()
        self._journal_path.unlink()
        self._lock.close()

    def done(self) -> set[int]:
        """Numbers of the runs that have a row."""
        return set(rows(self.folder).column("run").to_pylist()) if any(self.parts.glob("*.parquet")) else set()

    def add(self, row: dict[str, Any]) -> None:
        """Adds the row of a finished run."""
        self._journal.write((json.dumps(row) + "\n").encode())
        self._pending.append(row)
        if len(self._pending) >= PART_ROWS or time.monotonic() - self._written_s > PART_S:
            self.flush()

    def flush(self) -> None:
        """Turns the journal into a part."""
        if self._pending:
            _write(self.parts / f"{self._journal_path.stem}.parquet", table_of(self._pending))
            self._journal.close()
            self._journal_path.unlink()
            self._pending = []
            self._begin_part()
        self._written_s = time.monotonic()

    def forget_failed(self) -> None:
        """Removes the rows of failed runs, so that these are done again."""
        for part in sorted(self.parts.glob("*.parquet")):
            found = pq.read_table(part)
            good = found.filter(pa.compute.equal(found["status"], "done"))
            if len(good) < len(found):
                _write(part, good)

    def _begin_part(self) -> None:
        number = 1 + max((int(part.stem.removeprefix("part-")) for part in self.parts.glob("part-*.parquet")), default=-1)
        self._journal_path = self._journals / f"part-{number:06}.jsonl"
        self._journal = open(self._journal_path, "wb", buffering=0)  # noqa: SIM115, closed with its part

    def _refuse_another_study(self) -> None:
        try:
            there = json.loads((self.folder / "study.json").read_text(encoding="utf-8"))
        except FileNotFoundError:
            return
        except (OSError, ValueError) as why:
            raise Refusal(f"{self.folder}/study.json: {why}, allowed the file that a study wrote") from None
        for key, value in self.identity.items():
            if there.get(key) != value:
                raise Refusal(f"{self.folder}: found rows of a study with other {key}, allowed the same study or another folder")


def rows(out: Path) -> pa.Table:
    """All rows of a study in the order of their runs, as a pyarrow table (`.to_pandas()`, `.to_pylist()`).

    A running study stores its rows in parts: a part is written after 500 rows, or with the first row that comes more
    than 10 s after the part before. The table has the rows of all parts written so far. Raises Refusal when the folder
    has no rows.
    """
    parts = sorted((pathlib.Path(path_of(out)) / "rows").glob("part-*.parquet"))
    if not parts:
        raise Refusal(f"{out}: found no rows, allowed the folder of a study")
    tables = [pq.read_table(part) for part in parts]
    try:
        return pa.concat_tables(tables, promote_options="permissive").sort_by("run")
    except (pa.ArrowTypeError, pa.ArrowInvalid):  # a column that is a number in one part and a text in another
        return table_of([row for each in tables for row in each.to_pylist()]).sort_by("run")
