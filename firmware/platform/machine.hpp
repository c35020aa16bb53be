#pragma once
// Checks of the machine's settings, read from proc and sys. Each failed check names the command that corrects it.

#include <functional>
#include <string>
#include <vector>

namespace ligature::platform {

enum class Grade { kOk, kWarn, kFail };

struct Check {
  Grade grade;
  std::string what;  ///< "kernel", "locked memory", ..
  std::string found;
  std::string remedy;  ///< command, or line to add to a file; empty if nothing is wrong
};

/// Where settings are read from; tests use a folder of their own.
struct Machine {
  std::string root = "/";                                     ///< holds proc/ and sys/
  std::function<std::string(const std::string&)> ip_details;  ///< text of `ip -details link show INTERFACE`
};

/// All checks that need no bus: kernel, limits, core, frequency, idle states, clock source, network.
[[nodiscard]] std::vector<Check> check_machine(const Machine& machine, int core);

/// Checks of a CAN interface: up, 1 Mbit/s, sample point 75 .. 87.5 %, queue length, interrupts not on the core.
/// @param needs_fd whether the drives speak CAN FD, with 5 Mbit/s for the data
[[nodiscard]] std::vector<Check> check_can(const Machine& machine, const std::string& interface, int core,
                                           bool needs_fd = false);

/// Whether a core list in the kernel's format ("0,2-5") contains a core.
[[nodiscard]] bool list_holds(const std::string& list, int core);

/// Interface through which packets to an IPv4 address (host byte order) leave, from proc/net/route; empty: none.
[[nodiscard]] std::string route_of(const std::string& route_table, unsigned address);

}  // namespace ligature::platform
