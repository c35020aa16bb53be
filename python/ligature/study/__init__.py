"""Studies: many runs over parameters and seeds, on all cores or on a cluster, with their rows in Parquet.

    from ligature import study
    if __name__ == "__main__":  # the workers import this file
        study.Study.load("STUDY.toml").run("out/study")
        print(study.rows("out/study").to_pandas())

The same from a shell: `ligature-lab study STUDY.toml --out DIR`, or `python -m ligature.study`. The file's keys, the
tasks and the columns of a row: docs/studies.md. Needs the extra `study`: `pip install .[study]`.
"""

try:
    import distributed  # noqa: F401
    import pyarrow  # noqa: F401
except ModuleNotFoundError as error:
    if error.name not in ("distributed", "pyarrow"):
        raise
    raise ImportError(f"ligature.study: {error.name} is not installed; remedy: pip install .[study]") from None

from ligature.study.definition import Study
from ligature.study.runner import Ended
from ligature.study.statistics import Threshold, threshold, wilson
from ligature.study.store import rows

__all__ = ["Ended", "Study", "Threshold", "rows", "threshold", "wilson"]
