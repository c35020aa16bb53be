"""Checks every #include against the table RULES: which folder may include which; all others are forbidden.

This keeps, for example, file access and locks out of the code of the real-time threads. Run: python3
tests/architecture/include_rules.py [ROOT]; prints one line per violation and exits with 1 if any."""

import pathlib
import re
import sys

OURS = ("protocol/", "firmware/", "sim_device/", "bridge/", "host/", "python/")
SCENE_STRUCT = "protocol/scene/scene.hpp"
DEVICE_STRUCT = "protocol/device/device.hpp"

# folder: (our folders it may include besides itself, third-party and OS headers it may include)
RULES = {
    "protocol/can": ([], []),
    "protocol/can/describe": (["protocol/can"], ["OS"]),
    "protocol/scene": (["protocol/recorder/crc32.hpp"], ["toml++/"]),
    "protocol/scene/text_file.cpp": (["protocol/scene"], ["OS"]),  # the only file that opens files
    "protocol/device": ([SCENE_STRUCT, "protocol/scene/key_list.hpp", "protocol/scene/toml_text.hpp"], ["toml++/", "OS"]),
    "protocol/recorder": ([], []),
    "protocol/lcm": ([], ["OS"]),
    "firmware/rt": ([], []),
    "firmware/physics": (["firmware/rt", SCENE_STRUCT], ["Eigen/"]),
    "firmware/physics/image.cpp": (["firmware/physics", "protocol/recorder/crc32.hpp"], []),
    "firmware/control": (["firmware/rt", "firmware/physics", SCENE_STRUCT, DEVICE_STRUCT], ["Eigen/", "ruckig/"]),
    "firmware/platform": (["firmware/rt", "protocol/can", DEVICE_STRUCT], ["OS"]),
    "firmware/telemetry": (["firmware/rt", "protocol/recorder", "protocol/lcm", "ligature_msg"], ["lcm/", "OS"]),
    "firmware/clock.hpp": ([], []),
    "firmware/cycle.hpp": (["firmware/rt", "firmware/control", "firmware/physics", "firmware/clock.hpp"], []),
    "firmware/thread_context.hpp": (["firmware/rt", "firmware/control", "firmware/physics", "firmware/clock.hpp"], []),
    "firmware/app": (["firmware", "protocol", "ligature_msg"], ["CLI/", "spdlog/", "OS"]),
    # Reports about the machine, read and written by `doctor` alone: never while the rig runs.
    "firmware/app/doctor": (["firmware/app", "firmware/platform", "firmware/telemetry/disk.hpp"], ["nlohmann/", "OS"]),
    # Lets a web page steer a simulated hand; in a folder of its own, because the firmware must not include it.
    "sim_device/page": (["sim_device", "protocol/lcm", "ligature_msg"], ["ruckig/", "Eigen/", "lcm/", "OS"]),
    # A simulated operator that sees the thread by LCM messages, which anybody may have sent.
    "sim_device/tying": (["sim_device", "protocol/lcm", "protocol/scene", "ligature_msg"], ["lcm/", "OS"]),
    "sim_device": (["protocol/can", "protocol/scene", "protocol/device", "protocol/lcm/default_url.hpp", "sim_device/page", "sim_device/tying"], ["ruckig/", "Eigen/", "CLI/", "spdlog/", "nlohmann/", "OS"]),
    # A real device behind the drives of the simulated one; never the simulated mechanics.
    "bridge": (["sim_device/drive_node.hpp", "sim_device/event_loop.hpp", "sim_device/hand_device.hpp", "sim_device/kinematics.hpp", "sim_device/port.hpp", "sim_device/scheduling.hpp", "sim_device/wire.hpp", "protocol/can", "protocol/device"], ["boost/", "CLI/", "nlohmann/", "OS"]),
    "host/knot": ([], ["Eigen/"]),
    "host/console": (["host/errors.hpp"], ["OS"]),
    "host/lab/tie": (["firmware/physics", "sim_device", "protocol/scene", "host"], ["CLI/", "Eigen/", "OS"]),
    "host/lab": (["firmware/physics", "firmware/rt", "protocol/scene", "sim_device/operator", "host/console", "host/errors.hpp", "host/knot", "host/lab/tie", "host/lab/rerun", "host/lab/fit"], ["CLI/", "nlohmann/", "Eigen/", "OS"]),
    # Least squares with Eigen's Levenberg-Marquardt, which it calls unsupported.
    "host/lab/fit": (["host/lab", "protocol/scene"], ["Eigen/", "unsupported/Eigen/", "OS"]),
    # Repeats a recorded run; with the firmware's own reporting code, so that both runs' records can be bit-identical.
    "host/lab/rerun": (["firmware", "protocol/scene", "host", "ligature_msg"], ["CLI/", "nlohmann/", "Eigen/", "OS"]),
    # The whole rig in one process and in virtual time; only this folder may include all parts.
    "host/lab/rig": (["firmware", "sim_device", "protocol/can", "protocol/scene", "protocol/device", "host", "ligature_msg"], ["Eigen/", "OS"]),
    "host": (["protocol/scene", "protocol/recorder", "protocol/lcm", "host/console", "host/knot", "host/stream", "host/view", "ligature_msg"], ["lcm/", "CLI/", "nlohmann/", "spdlog/", "OS"]),
    "host/stream": (["host", "protocol/lcm", "ligature_msg"], ["boost/", "CLI/", "nlohmann/", "OS"]),
    # Shows a recording; must not be able to send messages.
    "host/view/replay.cpp": (["host/console", "host/view"], ["OS"]),
    "host/view": (["host", "protocol/scene", "protocol/lcm", "ligature_msg"], ["boost/", "CLI/", "nlohmann/", "OS"]),
    # The Python package: thread, scenes, knots and recordings; the rig only through the virtual one.
    "python/src/bind_rerun.cpp": (["python/src", "host/gap_counter.hpp", "host/lab/rerun", "protocol/scene"], ["nanobind/"]),
    "python/src/bind_rig.cpp": (["python/src", "firmware/telemetry/messages.hpp", "host/lab/rig/stepped_rig.hpp", "host/messages.hpp", "protocol/lcm/command_words.hpp", "protocol/scene"], ["nanobind/"]),
    "python/src": (["firmware/physics", "protocol/scene", "host/errors.hpp", "host/knot", "host/lab/every.hpp", "host/lab/outcome.hpp", "host/lab/script_tools.hpp", "host/lab/trace_row.hpp", "host/rig_facts.hpp", "host/recording_reader.hpp", "host/export_sink.hpp", "host/tick_columns.hpp"], ["nanobind/", "OS"]),
}

# Operating system headers and those for files, clocks, threads, sockets and streams. Folders without "OS" in their row
# may use none of them. <chrono> is allowed: its durations need no clock.
OS_HEADERS = re.compile(
    r"^(sys|linux|net|netinet|arpa)/|^(unistd|fcntl|poll|pthread|sched|signal|time|errno|dirent|termios|glob|malloc)\.h$"
    r"|^(fstream|iostream|filesystem|thread|mutex|condition_variable|future|csignal|ctime|cstdio|syncstream|semaphore)$"
)
# Random numbers that differ between standard libraries.
STRANGE_RANDOM = re.compile(r"std::\w+_distribution|std::(?:ranges::)?shuffle\(")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


# Message header -> the only folders that may include it: hand_wish_t is how a web page moves a simulated hand.
ONLY = {"ligature_msg/hand_wish_t.hpp": ("sim_device/page/", "host/view/")}


def folder_of(path):
    """The most specific folder of the table that contains the file, or None."""
    matches = [f for f in RULES if path == f or path.startswith(f + "/")]
    return max(matches, key=len) if matches else None


def violations(path, text):
    """Violations of one source file, as lines 'file: includes X, which FOLDER may not'."""
    folder = folder_of(path)
    if folder is None:
        return [f"{path}: lies in no folder of the include table"]
    ours, others = RULES[folder]
    found = []
    for _, header in INCLUDE.findall(text):
        if header.startswith(OURS) or header.startswith("ligature_msg/"):
            own = folder_of(header) == folder
            good = own or any(header == o or header.startswith(o + "/") for o in ours)
        elif "/" in header and not OS_HEADERS.match(header):
            good = any(header.startswith(o) for o in others)
        elif OS_HEADERS.match(header):
            good = "OS" in others or (folder == "protocol/scene" and header == "filesystem")
        else:
            good = True
        good = good and path.startswith(ONLY.get(header, ""))
        if not good:
            found.append(f"{path}: includes {header}, which {folder} may not")
    return found


def random_violations(path, text):
    """Random numbers must be the same with every standard library. Tests draw them from tests/support/random.hpp only,
    so that other seeds can be chosen with the variable LIGATURE_TEST_SEED."""
    found = set(STRANGE_RANDOM.findall(text))
    source = "protocol/scene/random.hpp"
    if path.startswith("tests/"):
        source = "tests/support/random.hpp"
        found |= set(re.findall(r"std::mt19937\w*|std::random_device", text))
    return [f"{path}: uses {word}; random numbers come from {source}" for word in sorted(found)]


def self_check():
    """Checks that the rules reject bad examples."""
    assert random_violations("tests/a.cpp", "std::mt19937 random(1);")
    assert not random_violations("tests/a.cpp", "test::Random random(1);")
    assert random_violations("host/a.cpp", "std::normal_distribution<double> normal;")
    assert not random_violations("host/a.cpp", "std::mt19937 random(1);")
    assert violations("firmware/physics/a.cpp", "#include <fstream>\n")
    assert violations("firmware/control/a.cpp", '#include "protocol/can/units.hpp"\n')
    assert violations("sim_device/a.cpp", '#include "firmware/rt/spsc_ring.hpp"\n')
    assert violations("protocol/can/a.hpp", "#include <Eigen/Core>\n")
    assert violations("firmware/telemetry/a.cpp", '#include "ligature_msg/hand_wish_t.hpp"\n')
    assert violations("sim_device/a.cpp", '#include "ligature_msg/hand_wish_t.hpp"\n')
    assert violations("host/view/replay.cpp", '#include "host/lcm_link.hpp"\n')
    assert not violations("firmware/physics/a.cpp", '#include <Eigen/Core>\n#include "firmware/rt/payload.hpp"\n')


def main():
    self_check()
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    files = [p for top in OURS for p in (root / top).rglob("*") if p.suffix in (".hpp", ".cpp", ".h")]
    found = [v for p in sorted(files) for v in violations(p.relative_to(root).as_posix(), p.read_text())]
    for p in sorted([*files, *(p for p in (root / "tests").rglob("*") if p.suffix in (".hpp", ".cpp"))]):
        found += random_violations(p.relative_to(root).as_posix(), p.read_text())
    print("\n".join(found) if found else f"include rules hold in {len(files)} files")
    return 1 if found or not files else 0


if __name__ == "__main__":
    sys.exit(main())
