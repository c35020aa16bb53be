"""Does the runs of a study that have no row yet, and writes each row as it comes."""

import contextlib
import itertools
import sys
from collections.abc import Iterator
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

from distributed import Client, Future, KilledWorker, as_completed

from ligature import __version__
from ligature._arch import COMMIT
from ligature.study.cluster import workers_of
from ligature.study.progress import Progress
from ligature.study.store import Store
from ligature.study.work import execute

if TYPE_CHECKING:
    from ligature.study.definition import Study


class Ended(NamedTuple):
    """How a call of Study.run ended."""

    runs: int  # of the study
    done_before: int  # had a row when the call began
    failed: int  # rows of this call with the status "failed"


def _failed(study: "Study", run: int, reason: str) -> dict[str, Any]:
    """The row of a run whose worker could not say anything."""
    parameters, seed = study.design[run]
    return {"run": run, "seed": seed, **parameters, "status": "failed", "reason": reason, "commit": COMMIT,
            "version": __version__}


class _Queue:
    """Keeps the workers busy, without sending all runs at once."""

    def __init__(self, client: Client, study: "Study", todo: Iterator[int]) -> None:
        self._client, self._study, self._todo = client, study, todo
        self._runs: dict[str, int] = {}
        self._lost: dict[int, int] = {}
        self._numbers = itertools.count()
        self._completed = as_completed()

    def rows(self) -> Iterator[dict[str, Any]]:
        """Rows in the order in which they come."""
        self._send(max(32, 4 * len(self._client.scheduler_info(n_workers=-1)["workers"])))
        for future in self._completed:
            run = self._runs.pop(future.key)
            row = self._row(run, future)
            future.release()
            if row is None:
                self._submit(run)
                continue
            self._send(1)
            yield row

    def _send(self, count: int) -> None:
        for run in itertools.islice(self._todo, count):
            self._submit(run)

    def _submit(self, run: int) -> None:
        # A name of its own for each attempt: the scheduler remembers finished ones by name.
        future = self._client.submit(execute, self._study.payload(run), pure=False, key=f"run-{run}-{next(self._numbers)}")
        self._runs[future.key] = run
        self._completed.add(future)

    def _row(self, run: int, future: Future) -> dict[str, Any] | None:
        """The row of a run; None: do it again."""
        if future.status == "finished":
            with contextlib.suppress(KilledWorker, CancelledError):  # its row is lost if its worker dies at once
                return future.result()
        elif future.status == "error" and not isinstance(why := future.exception(), KilledWorker):
            return _failed(self._study, run, f"{type(why).__name__}: {why}".replace("\n", " ")[:500])
        # A worker that dies takes the blame also for a run that only waited on it, so each gets two more chances.
        self._lost[run] = self._lost.get(run, 0) + 1
        return None if self._lost[run] < 3 else _failed(self._study, run, "its worker process died each time")


def run(study: "Study", out: str, retry_failed: bool = False, progress: TextIO | None = sys.stderr, **where: Any) -> Ended:
    """See Study.run."""
    with contextlib.ExitStack() as stack:
        # What is elsewhere may be refused, so it is reached before anything is written.
        elsewhere = where.get("scheduler") is not None or where.get("slurm") is not None
        client = stack.enter_context(workers_of(**where)) if elsewhere else None
        store = stack.enter_context(Store(out, study.identity(), study.text))
        if retry_failed:
            store.forget_failed()
        done = store.done()
        todo = [each for each in range(len(study)) if each not in done]
        ended = Ended(len(study), len(done), 0)
        if not todo:
            return ended
        queue = _Queue(client or stack.enter_context(workers_of(**where)), study, iter(todo))
        shown = stack.enter_context(Progress(len(study), len(done), progress))
        for row in queue.rows():
            store.add(row)
            failed = row["status"] == "failed"
            ended = ended._replace(failed=ended.failed + failed)
            shown.one_more(failed)
        return ended
