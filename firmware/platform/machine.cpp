#include "firmware/platform/machine.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "firmware/platform/realtime.hpp"

namespace ligature::platform {
namespace {

namespace fs = std::filesystem;
#ifdef __aarch64__
constexpr const char* kArchitecture = "arm64";  // as Debian names it
#else
constexpr const char* kArchitecture = "amd64";
#endif
constexpr long kReceiveBuffer = 4'194'304;
constexpr unsigned kMulticast = 0xEFFF4C43;  // 239.255.76.67, the default LCM group
constexpr unsigned kCapIpcLock = 14, kCapSysNice = 23;
constexpr long kWorstIdleExit_us = 20;

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  std::string s = text.str();
  while (!s.empty() && (s.back() == '\n' || s.back() == ' ')) s.pop_back();
  return s;
}

/// The whole number that a text begins with; 0 if there is none, as for a file that does not exist.
long whole_number(const std::string& text) { return std::strtol(text.c_str(), nullptr, 10); }

Check good(const char* what, std::string found) { return {Grade::kOk, what, std::move(found), {}}; }

std::string cpu(int core) { return "sys/devices/system/cpu/cpu" + std::to_string(core) + "/"; }

Check kernel(const std::string& root) {
  const std::string release = text_of(root + "proc/sys/kernel/osrelease");
  if (text_of(root + "sys/kernel/realtime") == "1") return good("kernel", release + ", PREEMPT_RT");
  return {Grade::kFail, "kernel", release + ", not PREEMPT_RT",
          std::string("apt install linux-image-rt-") + kArchitecture + " && reboot"};
}

/// The soft limit in proc/self/limits; "unlimited" becomes a very large number.
long limit(const std::string& root, const std::string& name) {
  std::istringstream lines(text_of(root + "proc/self/limits"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name)) continue;
    const std::string rest = line.substr(name.size());
    return rest.find_first_not_of(' ') == rest.find("unlimited") ? 1L << 62 : whole_number(rest);
  }
  return 0;
}

bool has_capability(const std::string& root, unsigned number) {
  std::istringstream lines(text_of(root + "proc/self/status"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("CapEff:")) return (std::strtoull(line.c_str() + 7, nullptr, 16) >> number & 1U) != 0;
  }
  return false;
}

std::string amount(long value) { return value >= 1L << 62 ? "unlimited" : std::to_string(value); }

constexpr const char* kLimits = "install limits.d/ligature.conf, join group 'realtime', log in again";

Check priority_limit(const std::string& root) {
  if (has_capability(root, kCapSysNice)) return good("real-time priority", "allowed by CAP_SYS_NICE");
  const long allowed = limit(root, "Max realtime priority");
  if (allowed >= kLoopPriority) return good("real-time priority", "up to " + amount(allowed));
  return {Grade::kFail, "real-time priority", "up to " + amount(allowed) + ", wanted 80", kLimits};
}

bool is_kernel_from(const std::string& root, int major, int minor) {
  int a = 0, b = 0;
  if (std::sscanf(text_of(root + "proc/sys/kernel/osrelease").c_str(), "%d.%d", &a, &b) != 2) return false;
  return a > major || (a == major && b >= minor);
}

/// Checks a limit of the kernel: real-time threads may use a core only for a given part of each second, and Linux stops
/// them all for the rest of the second. With a large scene the physics uses nearly all of the time, so this limit would
/// also stop the loop. Up to Linux 6.11 a sysctl sets the limit. From 6.12 on the "fair server" does: when threads of
/// normal priority have waited for 0.95 s on a core, it lets them run for `runtime` ns before real-time threads.
Check whole_core(const std::string& root, int core) {
  const std::string server = "sys/kernel/debug/sched/fair_server/cpu" + std::to_string(core) + "/runtime";
  const std::string runtime = text_of(root + server);
  if (runtime == "0") return good("real-time share", "the whole core (fair server off)");
  if (!runtime.empty())
    return {Grade::kWarn, "real-time share", "the fair server may take " + runtime + " ns of each second, wanted 0",
            "echo 0 > /" + server};
  if (is_kernel_from(root, 6, 12))
    return {Grade::kWarn, "real-time share", "not known: the fair server's setting cannot be read",
            "run this as root, with debugfs mounted, on a kernel that is not locked down; it is /" + server};
  const std::string found = text_of(root + "proc/sys/kernel/sched_rt_runtime_us");
  if (found.empty() || found == "-1") return good("real-time share", "the whole core");
  return {Grade::kWarn, "real-time share",
          found + " us of each " + text_of(root + "proc/sys/kernel/sched_rt_period_us") + ", wanted -1: no limit",
          "sysctl -w kernel.sched_rt_runtime_us=-1"};
}

Check memory_limit(const std::string& root) {
  if (has_capability(root, kCapIpcLock)) return good("locked memory", "allowed by CAP_IPC_LOCK");
  const long allowed = limit(root, "Max locked memory");
  if (allowed >= 1L << 62) return good("locked memory", "unlimited");
  return {Grade::kFail, "locked memory", amount(allowed) + " bytes, wanted unlimited", kLimits};
}

/// Checks that a core list of the kernel (such as the isolated cores) contains the real-time loop's core.
Check core_list(const std::string& root, const char* what, const std::string& file, const std::string& option,
                int core) {
  const std::string list = text_of(root + file);
  const std::string number = std::to_string(core);
  if (list_holds(list, core)) return good(what, "core " + number + " in " + list);
  return {Grade::kWarn, what, "core " + number + " not in '" + list + "'",
          "kernel command line: " + option + "=" + number + " (GRUB_CMDLINE_LINUX, update-grub, reboot)"};
}

Check rcu(const std::string& root, int core) {
  const std::string line = " " + text_of(root + "proc/cmdline") + " ";
  const auto at = line.find(" rcu_nocbs=");
  const std::string number = std::to_string(core);
  if (at != std::string::npos) {
    const auto from = at + 11;
    if (list_holds(line.substr(from, line.find(' ', from) - from), core))
      return good("RCU callbacks", "off core " + number);
  }
  return {Grade::kWarn, "RCU callbacks", "may run on core " + number,
          "kernel command line: rcu_nocbs=" + number + " (GRUB_CMDLINE_LINUX, update-grub, reboot)"};
}

Check governor(const std::string& root, int core) {
  const std::string file = root + cpu(core) + "cpufreq/scaling_governor";
  if (!fs::exists(file)) return good("frequency", "not scaled by this kernel");
  const std::string found = text_of(file);
  if (found == "performance") return good("frequency", "governor performance");
  return {Grade::kWarn, "frequency", "governor " + found,
          "cpupower -c " + std::to_string(core) + " frequency-set -g performance"};
}

/// Reports idle states whose exit latency would delay every wake-up.
Check idle(const std::string& root, int core) {
  std::error_code none;
  std::string slow;
  for (const auto& state : fs::directory_iterator(root + cpu(core) + "cpuidle", none)) {
    const std::string s = state.path().string();
    if (text_of(s + "/disable") == "1" || whole_number(text_of(s + "/latency")) <= kWorstIdleExit_us) continue;
    slow += (slow.empty() ? "" : ", ") + text_of(s + "/name") + " " + text_of(s + "/latency") + " us";
  }
  if (slow.empty()) return good("idle states", "none slower than 20 us");
  return {Grade::kWarn, "idle states", slow, "cpupower -c " + std::to_string(core) + " idle-set -D 20"};
}

Check clock_source(const std::string& root) {
  const std::string found = text_of(root + "sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (found != "hpet" && found != "acpi_pm" && found != "jiffies")
    return good("clock source", found.empty() ? "default" : found);
  return {Grade::kWarn, "clock source", found + ", slow to read", "kernel command line: tsc=reliable"};
}

Check multicast(const std::string& root) {
  const std::string by = route_of(text_of(root + "proc/net/route"), kMulticast);
  if (by == "lo") return good("LCM multicast", "by lo");
  if (!by.empty())
    return {Grade::kWarn, "LCM multicast", "by " + by + " (ttl=0 keeps it on this machine)",
            "ip route add 224.0.0.0/4 dev lo"};
  return {Grade::kFail, "LCM multicast", "no route", "ip link set lo up && ip route add 224.0.0.0/4 dev lo"};
}

Check receive_buffer(const std::string& root) {
  const std::string found = text_of(root + "proc/sys/net/core/rmem_max");
  if (whole_number(found) >= kReceiveBuffer) return good("receive buffer", "up to " + found + " bytes");
  return {Grade::kWarn, "receive buffer", "up to " + (found.empty() ? "?" : found) + " bytes",
          "sysctl -w net.core.rmem_max=4194304"};
}

/// The number after a word in a text; -1 if the word is missing.
double number_after(const std::string& text, const std::string& word) {
  const auto at = text.find(word);
  return at == std::string::npos ? -1.0 : std::strtod(text.c_str() + at + word.size(), nullptr);
}

/// Checks that the real-time loop's core handles no interrupt of the CAN interface, which may have several.
Check interrupts(const std::string& root, const std::string& interface, int core) {
  std::string numbers;
  std::istringstream lines(text_of(root + "proc/interrupts"));
  for (std::string line; std::getline(lines, line);) {
    if ((line + " ").find(" " + interface + " ") == std::string::npos) continue;
    const std::string number = std::to_string(whole_number(line));
    if (list_holds(text_of(root + "proc/irq/" + number + "/smp_affinity_list"), core))
      return {Grade::kWarn, "CAN interrupt",
              interface + ": irq " + number + " may come to core " + std::to_string(core),
              "echo 0 > /proc/irq/" + number + "/smp_affinity_list"};
    numbers += (numbers.empty() ? "" : ", ") + number;
  }
  return good("CAN interrupt",
              interface + (numbers.empty() ? ": none of its own"
                                           : ": irq " + numbers + " kept off core " + std::to_string(core)));
}

}  // namespace

bool list_holds(const std::string& list, int core) {
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    if (part.empty() || part[0] < '0' || part[0] > '9') continue;
    const long first = whole_number(part);
    const auto dash = part.find('-');
    const long last = dash == std::string::npos ? first : whole_number(part.substr(dash + 1));
    if (core >= first && core <= last) return true;
  }
  return false;
}

std::string route_of(const std::string& route_table, unsigned address) {
  std::istringstream lines(route_table);
  std::string line, best;
  unsigned best_mask = 0;
  std::getline(lines, line);  // column names
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string interface, skipped;
    unsigned destination = 0, mask = 0;
    fields >> interface >> std::hex >> destination;
    for (int i = 0; i < 5; ++i) fields >> skipped;  // gateway, flags, counters, metric
    fields >> mask;
    if (!fields) continue;
    destination = __builtin_bswap32(destination), mask = __builtin_bswap32(mask);  // printed in network order
    if ((address & mask) == destination && (best.empty() || mask > best_mask)) best = interface, best_mask = mask;
  }
  return best;
}

std::vector<Check> check_machine(const Machine& machine, int core) {
  const std::string& root = machine.root;
  return {kernel(root),
          priority_limit(root),
          whole_core(root, core),
          memory_limit(root),
          core_list(root, "own core", "sys/devices/system/cpu/isolated", "isolcpus", core),
          core_list(root, "timer ticks", "sys/devices/system/cpu/nohz_full", "nohz_full", core),
          rcu(root, core),
          governor(root, core),
          idle(root, core),
          clock_source(root),
          multicast(root),
          receive_buffer(root)};
}

constexpr double kFdDataRate = 5e6;

std::vector<Check> check_can(const Machine& machine, const std::string& interface, int core, bool needs_fd) {
  const std::string folder = machine.root + "sys/class/net/" + interface;
  if (!fs::exists(folder)) return {{Grade::kFail, "CAN", interface + ": no such interface", "ip link show type can"}};
  std::vector<Check> checks;
  const bool up = (std::strtoul(text_of(folder + "/flags").c_str(), nullptr, 16) & 1U) != 0;
  const std::string details = machine.ip_details(interface);
  const bool off = details.find("state BUS-OFF") != std::string::npos;  // an interface in bus-off still counts as up
  const std::string set = "ip link set " + interface;
  checks.push_back(up && !off ? good("CAN", interface + ": up")
                   : off      ? Check{Grade::kFail, "CAN", interface + ": bus-off",
                                 "find the cause, then: " + set + " down && " + set + " up"}
                              : Check{Grade::kFail, "CAN", interface + ": down", set + " up"});
  const bool is_virtual = details.find("vcan") != std::string::npos;
  if (is_virtual) {
    checks.push_back(good("CAN bit rate", interface + ": virtual, has none"));
  } else {
    const double rate = number_after(details, " bitrate "), point = number_after(details, " sample-point ");
    std::ostringstream found;
    found << interface << ": " << rate << " bit/s, sample point " << point;
    const bool fine = rate == 1e6 && point >= 0.75 && point <= 0.875;
    checks.push_back({fine ? Grade::kOk : Grade::kFail, "CAN bit rate", found.str(),
                      fine ? "" : set + " down && " + set + " up type can bitrate 1000000 sample-point 0.8"});
  }
  if (needs_fd) {
    const double rate = is_virtual ? kFdDataRate : number_after(details, " dbitrate ");
    const bool fine = text_of(folder + "/mtu") == "72" && rate == kFdDataRate;
    std::ostringstream found;
    found << interface << (fine ? ": " : ": not on, or another rate than 5e+06; found ") << rate << " bit/s for data";
    checks.push_back({fine ? Grade::kOk : Grade::kFail, "CAN FD", found.str(),
                      fine ? "" : set + " down && " + set + " up type can bitrate 1000000 dbitrate 5000000 fd on"});
  }
  // A period has up to six frames. In a longer queue, frames would wait on a busy bus, become outdated, and still reset
  // the drives' watchdogs.
  const std::string queue = text_of(folder + "/tx_queue_len");
  const long frames = whole_number(queue);
  checks.push_back(
      frames >= 8 && frames <= 16
          ? good("CAN queue", interface + ": " + queue)
          : Check{Grade::kWarn, "CAN queue", interface + ": " + queue + ", wanted 8 to 16", set + " txqueuelen 8"});
  checks.push_back(interrupts(machine.root, interface, core));
  return checks;
}

}  // namespace ligature::platform
