"""The command: python -m ligature.study STUDY.toml --out DIR, which `ligature-lab study` starts."""

import argparse
import signal
import sys
from typing import Any, NoReturn

from ligature import Refusal
from ligature.study import Study

DONE, BAD_INPUT, RUN_FAILED, INTERRUPTED = 0, 2, 3, 130
ABOUT = """Many runs over parameters and seeds: rows in DIR/rows (Parquet), one for each run. Called again, it does what has
no row yet, also after it was killed. Keys of STUDY.toml, tasks and columns: docs/studies.md."""
EXIT = """Exit: 0 done; 2 bad usage or input, nothing written; 3 a run failed, its row has the reason, or a file
could not be written; 130 interrupted, finished runs are kept.

Examples
  ligature-lab study STUDY.toml --out out/study                      every core of this machine
  ligature-lab study STUDY.toml --out out/study --scheduler tcp://HOST:8786
  ligature-lab study STUDY.toml --out out/study --slurm 40 --slurm-set queue=short
  ligature-lab study STUDY.toml --out out/study --plot               tables and pictures of the rows"""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise Refusal(f"study: {message} (see ligature-lab study --help)")


def _count(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 10_000:
        raise argparse.ArgumentTypeError(f"found {text!r}, allowed 1 .. 10000")
    return int(text)


def _setting(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals or not name.isidentifier():
        raise argparse.ArgumentTypeError(f"found {text!r}, allowed KEY=VALUE")
    return name, int(value) if value.isdecimal() else value


def _parser() -> _Parser:
    parser = _Parser("ligature-lab study", description=ABOUT, epilog=EXIT, allow_abbrev=False,
                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", metavar="STUDY.toml")
    parser.add_argument("--out", metavar="DIR", required=True, help="folder of the rows, tables and pictures")
    parser.add_argument("--workers", type=_count, metavar="N", help="processes of this machine [one for each core]")
    parser.add_argument("--scheduler", metavar="tcp://HOST:PORT", help="a Dask scheduler that is running")
    parser.add_argument("--slurm", type=_count, metavar="JOBS", help="jobs of Slurm, with one worker each")
    parser.add_argument("--slurm-set", type=_setting, action="append", default=[], metavar="KEY=VALUE",
                        help="keyword of dask_jobqueue.SLURMCluster, such as queue, account, walltime; repeatable")
    parser.add_argument("--retry-failed", action="store_true", help="do failed runs again")
    parser.add_argument("--plot", action="store_true", help="no runs: tables and pictures of the rows there are")
    return parser


def _interrupted(*_: Any) -> NoReturn:
    raise KeyboardInterrupt


def command(words: list[str]) -> int:
    """Does what the command line asks. @returns the exit code."""
    asked = _parser().parse_args(words)
    study = Study.load(asked.study)
    if asked.plot:
        for path in study.plot(asked.out):
            print(path)
        return DONE
    ended = study.run(asked.out, workers=asked.workers, scheduler=asked.scheduler, slurm=asked.slurm,
                      slurm_options=dict(asked.slurm_set), retry_failed=asked.retry_failed)
    new = ended.runs - ended.done_before
    print(f"study: {ended.runs} rows in {asked.out}/rows, {new} of them new, {ended.failed} of the new ones failed")
    return RUN_FAILED if ended.failed else DONE


def main() -> int:
    """The command with the words of the process."""
    signal.signal(signal.SIGTERM, _interrupted)
    try:
        return command(sys.argv[1:])
    except Refusal as why:
        print(f"ligature-lab: {why}", file=sys.stderr)
        return BAD_INPUT
    except OSError as why:  # a disk that is full, a folder that is gone
        print(f"ligature-lab: study: {why}; the same command continues it", file=sys.stderr)
        return RUN_FAILED
    except KeyboardInterrupt:
        print("ligature-lab: study: interrupted; the same command continues it", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
