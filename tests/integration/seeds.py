"""Seeds for the random input of the Python tests, shifted by LIGATURE_TEST_SEED as in tests/support/random.hpp. Creates the
file LIGATURE_TEST_DREW, which tells scripts/sweep that the test draws."""
import os
import pathlib


def shifted(seed):
    """A different seed for each shift; the seed itself without a shift."""
    text = os.environ.get("LIGATURE_TEST_SEED") or "0"
    if not (text.isascii() and text.isdigit()):
        raise SystemExit(f"LIGATURE_TEST_SEED is {text!r}, allowed: a whole number, 0 .. 2^64 - 1")
    if drew := os.environ.get("LIGATURE_TEST_DREW"):
        pathlib.Path(drew).touch()
    return seed + 1_000_003 * int(text)
