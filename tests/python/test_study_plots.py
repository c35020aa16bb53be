"""Tables and pictures of studies: intervals against scipy's, thresholds against known ones, fronts by hand."""

import csv

import numpy as np
import pytest
import scipy.stats

import ligature
from ligature.study import Study, threshold, wilson
from ligature.study.statistics import mean
from ligature.study.store import Store
from studies import SEED, called, study_file


def test_intervals_are_those_of_scipy():
    for yes, of in ((0, 5), (5, 5), (2, 5), (37, 50), (1, 1000)):
        expected = scipy.stats.binomtest(yes, of).proportion_ci(method="wilson")
        assert wilson(yes, of) == pytest.approx(expected, abs=1e-12)
    values = np.random.default_rng(SEED).normal(3.0, 2.0, 400)
    for n in (2, 5, 11, 12, 40, 400):
        expected = scipy.stats.t.interval(0.95, n - 1, values[:n].mean(), scipy.stats.sem(values[:n]))
        assert mean(values[:n])[1:] == pytest.approx(expected, rel=1e-3, abs=1e-3)


def drawn(rng, at, width):
    x = np.repeat(np.linspace(0.14, 0.41, 10), 5)
    return x, rng.random(len(x)) < 1 / (1 + np.exp(-(x - at) / width))


def test_threshold_interval_has_the_true_value():
    """Intervals of 95 %: of 150 draws at widths 0.005, 0.02 and 0.05 each, 148, 143 and 141 contained the true value.

    If the share is 0.95, fewer than 130 of 150 come in one of 40,000 draws.
    """
    rng = np.random.default_rng(SEED)
    held = 0
    for i in range(150):
        at = rng.uniform(0.2, 0.35)
        found = threshold(*drawn(rng, at, 0.02), seed=i)
        low, high = np.nan_to_num(found.low, nan=-9), np.nan_to_num(found.high, nan=9)
        held += low <= at <= high and found.side != "not rising"
    assert held >= 130, held


def test_thresholds_at_the_edges():
    x = np.repeat([0.1, 0.2, 0.3, 0.4], 5)
    jump = threshold(x, x > 0.25)  # a jump, where the largest likelihood has no slope
    assert jump.at == pytest.approx(0.25) and 0.2 < jump.low < 0.25 < jump.high < 0.3 and jump.side == "within"
    assert threshold(x, x > 0).side == "below" and threshold(x, x > 1).side == "above" and np.isnan(threshold(x, x > 1).at)
    assert threshold([1, 1], [True, False]).side == "unknown"
    assert threshold(x, x < 0.25).side == "not rising"
    both = np.repeat(np.linspace(0.14, 0.41, 10), 5)  # true at both ends, not in the middle
    assert threshold(both, abs(both - 0.25) > 0.05).side == "not rising"


def test_few_rising_shares_are_taken_for_others():
    """Of 100 draws with a rising share, one is expected to deviate so much; more than 7 come in one of 100,000."""
    rng = np.random.default_rng(SEED + 7)
    assert sum(threshold(*drawn(rng, rng.uniform(0.2, 0.35), 0.05), seed=i).side == "not rising" for i in range(100)) <= 7


def told(out, name):
    with open(out / f"{name}.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_tables_and_pictures(tmp_path):
    path = study_file(tmp_path, "square", 6, seeds="1-4", more='''
[[plot]]
name = "where"
kind = "map"
x = "x"
y = "seed"
measure = "odd"
[[plot]]
kind = "map"
x = "x"
y = "status"
measure = "square"
[[plot]]
name = "passes"
kind = "threshold"
over = "x"
measure = "big"
[[plot]]
name = "best"
kind = "front"
cost = "x"
error = "cpu_s"
lines = []
label = ["x"]
''')
    study = Study.load(path)
    assert called(path, "--out", tmp_path / "out", "--plot").returncode == 2  # no rows yet
    with Store(str(tmp_path / "out"), study.identity(), study.text) as store:
        for run in range(len(study)):
            parameters, seed = study.design[run]
            x = parameters["x"]
            failed = {"status": "failed", "reason": "one"} if run == 1 else {"status": "done", "reason": ""}
            store.add({"run": run, "seed": seed, "x": x, "square": float(x * x + seed), "odd": x % 2 == 1, "big": x > 3,
                       "cpu_s": [9.0, 3.0, 5.0, 2.0, 2.5, 2.0][x - 1]} | failed)
    done = called(path, "--out", tmp_path / "out", "--plot")
    assert done.returncode == 0 and len(done.stdout.split()) == 8, done
    for name in ("where", "map-2", "passes", "best"):
        assert (tmp_path / "out" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    where = told(tmp_path / "out", "where")
    assert len(where) == 24 and where[0] == {"x": "1", "seed": "1", "runs": "1", "failed": "0", "yes": "1", "value": "1", "low": "0.206549", "high": "1"}
    assert [row["failed"] for row in where[:3]] == ["0", "1", "0"] and where[1]["runs"] == "0"
    means = told(tmp_path / "out", "map-2")
    third = next(row for row in means if row["x"] == "3")
    assert (third["value"], third["low"], third["high"]) == ("11.5", "9.44574", "13.5543") and third["yes"] == ""
    passes = told(tmp_path / "out", "passes")
    assert float(passes[0]["at"]) == pytest.approx(3.5, abs=0.01) and passes[0]["side"] == "within" and passes[0]["failed"] == "1"
    assert [row["front"] for row in told(tmp_path / "out", "best")] == ["1", "1", "0", "1", "0", "0"]


def test_a_plot_of_a_text_is_refused(tmp_path):
    path = study_file(tmp_path, "square", 1, more='[[plot]]\nkind = "map"\nx = "x"\ny = "seed"\nmeasure = "name"\n')
    study = Study.load(path)
    study.run(tmp_path / "out", workers=1, progress=None)
    with pytest.raises(ligature.Refusal, match="column 'name' of run 0: found '1', allowed a number"):
        study.plot(tmp_path / "out")


@pytest.mark.parametrize("plot,says", [
    ('kind = "threshold"\nover = "name"\nmeasure = "odd"', "column 'name' of run 0: found '1', allowed a number"),
    ('kind = "threshold"\nover = "x"\nmeasure = "odd"\npanels = ["wide"]', "column 'wide': found none of this name, allowed one of .*square"),
    ('kind = "map"\nx = "x"\ny = "wide"\nmeasure = "odd"', "column 'wide': found none of this name"),
])
def test_a_plot_over_a_text_or_a_missing_column_is_refused(tmp_path, plot, says):
    study = Study.load(study_file(tmp_path, "square", 2, more=f"[[plot]]\n{plot}\n"))
    study.run(tmp_path / "out", workers=1, progress=None)
    with pytest.raises(ligature.Refusal, match=says):
        study.plot(tmp_path / "out")
