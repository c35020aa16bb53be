"""Intervals: Wilson's for a share, Student's for a mean, and the threshold of a share along a parameter."""

import math
from typing import Any, NamedTuple

import numpy as np

Z_95 = 1.959963984540054
# Student's t for 95 %, by degrees of freedom from 1; above, an expansion about the normal one
T_95 = (12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462, 2.30600, 2.26216, 2.22814)
DRAWS = 1000
STEPS = 60  # of Newton's method at most


def wilson(yes: int, of: int) -> tuple[float, float]:
    """95 % interval of a share of which `yes` of `of` were counted (Wilson 1927). Without any: 0 to 1."""
    if of == 0:
        return 0.0, 1.0
    share, correction = yes / of, Z_95**2 / of
    middle = (share + correction / 2) / (1 + correction)
    half = Z_95 / (1 + correction) * math.sqrt(share * (1 - share) / of + correction / (4 * of))
    return max(0.0, middle - half) if yes else 0.0, min(1.0, middle + half) if yes < of else 1.0


def student(freedom: int) -> float:
    """Student's t for a 95 % interval."""
    if freedom <= len(T_95):
        return T_95[freedom - 1]
    z = Z_95
    return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)


def mean(values: np.ndarray) -> tuple[float, float, float]:
    """Mean and its 95 % interval by Student's t; nan where there are too few values."""
    n = len(values)
    if n < 2:
        return (float(values[0]) if n else math.nan), math.nan, math.nan
    t = student(n - 1)
    middle, half = float(np.mean(values)), t * float(np.std(values, ddof=1)) / math.sqrt(n)
    return middle, middle - half, middle + half


class Threshold(NamedTuple):
    """Where a share passes one half. nan: not within the tested values, or not known on that side."""

    at: float
    low: float  # 95 % interval
    high: float
    side: str  # "within", "below" or "above" the tested values; "not rising": no such fit; "unknown": fewer than two values


def _shares(level: np.ndarray, slope: np.ndarray, x: np.ndarray) -> np.ndarray:
    return 1 / (1 + np.exp(-np.clip(level[:, None] + slope[:, None] * x, -30, 30)))


def _fit(x: np.ndarray, yes: np.ndarray, of: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Logistic fits by Firth's penalised likelihood (Biometrika 80 (1993) 27), one for each row of `yes`.

    It stays finite when the share jumps from 0 to 1, where the largest likelihood has no slope.
    """
    level, slope = np.zeros(len(yes)), np.zeros(len(yes))
    for _ in range(STEPS):
        p = _shares(level, slope, x)
        weight = of * p * (1 - p)
        s0, s1, s2 = weight.sum(1), (weight * x).sum(1), (weight * x * x).sum(1)
        det = np.maximum(s0 * s2 - s1 * s1, 1e-12)
        leverage = weight * (s2[:, None] - 2 * x * s1[:, None] + x * x * s0[:, None]) / det[:, None]
        rest = yes - of * p + leverage * (0.5 - p)
        g0, g1 = rest.sum(1), (rest * x).sum(1)
        step0, step1 = (s2 * g0 - s1 * g1) / det, (s0 * g1 - s1 * g0) / det
        shorter = np.minimum(1, 2 / np.maximum(np.hypot(step0, step1), 1e-12))
        level, slope = level + shorter * step0, slope + shorter * step1
        if max(np.abs(step0).max(), np.abs(step1).max()) < 1e-8:
            break
    return level, slope


def _crossing(level: np.ndarray, slope: np.ndarray, yes: np.ndarray, of: np.ndarray) -> np.ndarray:
    """Where each fit is one half; infinite where the share does not rise."""
    rises = slope > 1e-9
    never = np.where(2 * yes.sum(1) > of.sum(), -np.inf, np.inf)
    return np.where(rises, -level / np.where(rises, slope, 1), never)


def _deviance(p: np.ndarray, yes: np.ndarray, of: np.ndarray) -> np.ndarray:
    """How badly each fit describes the outcomes: twice the loss of log-likelihood against their own shares."""
    parts = [np.where(k > 0, k * np.log(np.maximum(k, 1e-300) / np.maximum(of * q, 1e-300)), 0.0)
             for k, q in ((yes, p), (of - yes, 1 - p))]
    return 2 * (parts[0] + parts[1]).sum(-1)


def threshold(x: Any, outcome: Any, seed: int = 1) -> Threshold:
    """The value of x above which an outcome comes in more than half of the runs, from a logistic fit.

    x, outcome: one number and one truth value for each run; the share of true outcomes must rise with x. The 95 %
    interval is a parametric bootstrap: outcomes are drawn 1000 times from the fitted curve, and each draw is fitted
    again. The draws also test the fit: if fewer than 1 % of them deviate as much from their fit as the outcomes do from
    theirs, there is no threshold ("not rising").
    """
    x, outcome = np.asarray(x, dtype=float), np.asarray(outcome, dtype=bool)
    places, which = np.unique(x, return_inverse=True)
    of = np.bincount(which).astype(float)
    yes = np.bincount(which, weights=outcome)[None, :]
    if len(places) < 2:
        return Threshold(math.nan, math.nan, math.nan, "unknown")
    if yes.sum() in (0, of.sum()):
        return Threshold(math.nan, math.nan, math.nan, "below" if yes.sum() else "above")
    middle, half = 0.5 * (places[0] + places[-1]), 0.5 * (places[-1] - places[0])
    u = (places - middle) / half
    fit = _fit(u, yes, of)
    at = _crossing(*fit, yes, of)[0]
    p = _shares(*fit, u)
    drawn = np.random.default_rng(seed).binomial(of.astype(int), p[0], (DRAWS, len(u))).astype(float)
    fits = _fit(u, drawn, of)
    if np.mean(_deviance(_shares(*fits, u), drawn, of) >= _deviance(p, yes, of) - 1e-9) < 0.01 or fit[1][0] <= 0:
        return Threshold(math.nan, math.nan, math.nan, "not rising")
    again = np.sort(_crossing(*fits, drawn, of))
    low, high = again[round(0.025 * DRAWS)], again[round(0.975 * DRAWS) - 1]
    side = "below" if at < -1 else "above" if at > 1 else "within"
    inside = [middle + half * value if -1 <= value <= 1 else math.nan for value in (at, low, high)]
    return Threshold(*(float(value) for value in inside), side)
