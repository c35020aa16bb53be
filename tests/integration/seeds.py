"""Seeds of the Python tests' random input, shifted like those of tests/support/random.hpp: LIGATURE_TEST_SEED."""
import os


def shifted(seed):
    """Another seed for each shift; the seed itself without one."""
    text = os.environ.get("LIGATURE_TEST_SEED") or "0"
    if not (text.isascii() and text.isdigit()):
        raise SystemExit(f"LIGATURE_TEST_SEED is {text!r}, allowed: a whole number, 0 .. 2^64 - 1")
    return seed + 1_000_003 * int(text)
