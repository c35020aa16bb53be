"""Checks the CPU before the extension is loaded: an unsupported instruction would kill the interpreter."""

import pathlib

from ligature._arch import ARCH

NEEDED = {"x86-64-v3": ("avx", "avx2", "fma", "bmi2"), "x86-64-v2": ("ssse3", "sse4_2", "popcnt")}


def lacking(arch: str, cpuinfo: str) -> list[str]:
    """Features that `arch` needs and the first `flags` line of /proc/cpuinfo lacks; empty without such a line."""
    flags = next((line.split() for line in cpuinfo.splitlines() if line.startswith("flags")), None)
    return [] if flags is None else [feature for feature in NEEDED.get(arch, ()) if feature not in flags]


def require() -> None:
    """Raises ImportError when this CPU lacks a needed feature."""
    try:
        missing = lacking(ARCH, pathlib.Path("/proc/cpuinfo").read_text())
    except OSError:
        return
    if missing:
        raise ImportError(f"ligature: this CPU lacks {' '.join(missing)}, and this build is for {ARCH}; "
                          "remedy: pip install . --config-settings=cmake.define.LIGATURE_ARCH=x86-64-v2 makes a build for every x86-64 since 2009")
