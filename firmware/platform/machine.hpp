#pragma once
// What the machine is set up to be, read from where the kernel says it. Every check has the command that mends it.

#include <functional>
#include <string>
#include <vector>

namespace ligature::platform {

enum class Grade { kOk, kWarn, kFail };

struct Check {
  Grade grade;
  std::string what;  ///< "kernel", "locked memory", ..
  std::string found;
  std::string remedy;  ///< a command or a line to add; empty when there is nothing to mend
};

/// Where to look; tests put a folder of their own there.
struct Machine {
  std::string root = "/";                                     ///< holds proc/ and sys/
  std::function<std::string(const std::string&)> ip_details;  ///< text of `ip -details link show INTERFACE`
};

/// Kernel, limits, core, frequency, idle states, clock source, network: everything that needs no bus.
[[nodiscard]] std::vector<Check> check_machine(const Machine& machine, int core);

/// A CAN interface: up, 1 Mbit/s, sample point 75 .. 87.5 %, queue, and its interrupts off the core.
[[nodiscard]] std::vector<Check> check_can(const Machine& machine, const std::string& interface, int core);

/// Whether a list as the kernel writes it ("0,2-5") holds a core.
[[nodiscard]] bool list_holds(const std::string& list, int core);

/// The interface by which packets to an IPv4 address (host byte order) leave; empty: none. From proc/net/route.
[[nodiscard]] std::string route_of(const std::string& route_table, unsigned address);

}  // namespace ligature::platform
