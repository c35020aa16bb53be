#include "firmware/platform/core_checks.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "firmware/platform/realtime.hpp"

namespace ligature::platform {
namespace {

namespace fs = std::filesystem;

std::string line_of(const std::string& path) {
  std::string line;
  std::ifstream file(path);
  std::getline(file, line);
  return line;
}

/// Two hardware threads of a core share its execution units: work of one slows the other.
Check sibling(const std::string& root, int core) {
  const std::string list =
      line_of(root + "sys/devices/system/cpu/cpu" + std::to_string(core) + "/topology/thread_siblings_list");
  if (list.find_first_of(",-") == std::string::npos) return {Grade::kOk, "sibling thread", "none", {}};
  return {Grade::kWarn, "sibling thread", "the core's hardware threads are " + list,
          "switch SMT off: echo off > /sys/devices/system/cpu/smt/control, or in the BIOS"};
}

/// Real-time priority in a line of proc/PID/stat; 0: none, or no such line.
long priority_in(const std::string& stat) {
  const auto name_end = stat.rfind(')');  // the name before it may contain anything
  if (name_end == std::string::npos) return 0;
  std::istringstream fields(stat.substr(name_end + 1));
  constexpr int kField = 40, kFirst = 3;  // proc(5): rt_priority is field 40; the state behind the name is field 3
  std::string field;
  for (int i = kFirst; i <= kField; ++i)
    if (!(fields >> field)) return 0;
  return std::strtol(field.c_str(), nullptr, 10);
}

Check interrupt_threads(const std::string& root) {
  std::string above, first;
  std::error_code none;
  for (const auto& process : fs::directory_iterator(root + "proc", none)) {
    const std::string number = process.path().filename().string();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string name = line_of(process.path().string() + "/comm");
    if (!name.starts_with("irq/")) continue;
    const long priority = priority_in(line_of(process.path().string() + "/stat"));
    if (priority < kLoopPriority) continue;
    above += (above.empty() ? "" : ", ") + name + " " + std::to_string(priority);
    if (first.empty()) first = number;
  }
  if (above.empty())
    return {Grade::kOk, "interrupt threads", "none at priority " + std::to_string(kLoopPriority) + " or above", {}};
  return {Grade::kWarn, "interrupt threads", above + ": not below the loop", "chrt --fifo --pid 50 " + first};
}

}  // namespace

std::vector<Check> check_core(const Machine& machine, int core) {
  return {sibling(machine.root, core), interrupt_threads(machine.root)};
}

}  // namespace ligature::platform
