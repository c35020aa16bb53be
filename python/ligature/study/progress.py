"""A bar on the terminal with the time left; in a file, a line every ten seconds."""

import time
from typing import Any, Self, TextIO

WIDTH, TERMINAL_S, FILE_S = 30, 0.2, 10.0


def span(seconds: float) -> str:
    """A time as people say it: 45 s, 12 min 5 s, 3 h 20 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


class Progress:
    """Counts the runs of a study. `stream` None: shows nothing."""

    def __init__(self, total: int, before: int, stream: TextIO | None) -> None:
        self._total, self._before, self._stream = total, before, stream
        self._new = self._failed = 0
        self._begun_s = time.monotonic()
        self._shown_s = float("-inf")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: Any) -> None:
        self._show(last=True)

    def one_more(self, failed: bool) -> None:
        """One run has ended."""
        self._new += 1
        self._failed += failed
        self._show()

    def text(self, passed_s: float) -> str:
        """The line after so many seconds."""
        done = self._before + self._new
        bar = "#" * (WIDTH * done // self._total)
        failed = f", {self._failed} failed" if self._failed else ""
        left = f", {span(passed_s / self._new * (self._total - done))} left" if self._new and done < self._total else ""
        return f"[{bar:{WIDTH}}] {done} of {self._total}{failed}{left}"

    def _show(self, last: bool = False) -> None:
        if self._stream is None:
            return
        now_s, terminal = time.monotonic(), self._stream.isatty()
        if now_s - self._shown_s < (TERMINAL_S if terminal else FILE_S) and not last:
            return
        self._shown_s = now_s
        line = self.text(now_s - self._begun_s)
        self._stream.write(f"\r{line}\x1b[K" + ("\n" if last else "") if terminal else line + "\n")
        self._stream.flush()
