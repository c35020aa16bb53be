#include "firmware/app/doctor.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdio>
#include <memory>
#include <thread>

#include "firmware/app/drive_checks.hpp"
#include "firmware/platform/monotonic_clock.hpp"
#include "firmware/platform/realtime.hpp"

namespace ligature::app {
namespace {

using platform::Check;
using platform::Grade;

constexpr auto kPeriod = std::chrono::milliseconds(1);
constexpr std::int64_t kGood_ns = 100'000, kUsable_ns = 300'000;
constexpr std::size_t kBins = 12;  // upper bounds 1, 2, 4, .. 1024 us, and one bin for longer

/// Output of a shell command. `interface` was validated before, so it cannot inject shell syntax.
std::string ip_details(const std::string& interface) {
  const std::string command = "ip -details link show " + interface + " 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 512> part;
  while (pipe && std::fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

struct Latency {
  rt::DurationStatistics wakeup;
  std::vector<std::uint64_t> bins = std::vector<std::uint64_t>(kBins);
  platform::Refusals refusals;
};

std::size_t bin_of(std::int64_t latency_ns) {
  const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(latency_ns, 0)) / 1000;
  return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(us)), kBins - 1);
}

std::atomic<bool> g_stop{false};

/// Wakes up every millisecond like the loop, with the same priority and locked memory, and does no other work.
Latency measure_wakeups(double seconds, int core) {
  Latency result;
  result.refusals = platform::lock_memory();
  std::thread([&] {
    for (const auto& r : platform::make_realtime(core)) result.refusals.push_back(r);
    platform::MonotonicClock clock;
    auto due = clock.now() + kPeriod;
    const auto end = due + std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
    for (; due < end && !g_stop; due += kPeriod) {
      clock.sleep_until(due);
      const auto late = clock.now() - due;
      result.wakeup.add(late.count());
      ++result.bins[bin_of(late.count())];
      due += late / kPeriod * kPeriod;  // lost periods are skipped, as in the loop
    }
  }).join();
  return result;
}

const char* word(Grade g) { return g == Grade::kOk ? "OK  " : g == Grade::kWarn ? "WARN" : "FAIL"; }

}  // namespace

Check judge(const rt::DurationStatistics& wakeup) {
  char found[96];
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  std::snprintf(found, sizeof found, "p50 %.1f, p99.9 %.1f, worst %.1f us", us(wakeup.quantile_ns(0.5)),
                us(wakeup.quantile_ns(0.999)), us(wakeup.max_ns()));
  if (wakeup.max_ns() < kGood_ns) return {Grade::kOk, "wake-up latency", found, {}};
  return {wakeup.max_ns() < kUsable_ns ? Grade::kWarn : Grade::kFail, "wake-up latency", found,
          "mend the rows above, take other work off this machine; 'rtla timerlat hist' finds the culprit"};
}

std::string table(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& c : checks) {
    char row[400];
    std::snprintf(row, sizeof row, "%s  %-20s %s\n", word(c.grade), c.what.c_str(), c.found.c_str());
    text += row;
    if (!c.remedy.empty()) text += "      " + std::string(20, ' ') + " -> " + c.remedy + "\n";
  }
  return text;
}

std::string histogram(const rt::DurationStatistics& wakeup, const std::vector<std::uint64_t>& bins) {
  std::string text = "wake-up latency, us        wake-ups\n";
  const auto most = std::max<std::uint64_t>(1, *std::ranges::max_element(bins));
  for (std::size_t i = 0; i < bins.size(); ++i) {
    char row[96];
    const bool last = i + 1 == bins.size();
    std::snprintf(row, sizeof row, "  %s %5u  %14llu  ", last ? "from" : "   <", 1U << (last ? bins.size() - 2 : i),
                  static_cast<unsigned long long>(bins[i]));
    text += row + std::string((40 * bins[i] + most - 1) / most, '#') + "\n";
  }
  return text + "  " + std::to_string(wakeup.count()) + " in all\n";
}

int doctor(const DoctorOptions& options) {
  struct sigaction action {};
  action.sa_handler = [](int) { g_stop = true; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::variant<std::vector<Check>, std::string> drives;
  if (!options.device.empty()) drives = drive_checks(options.device);
  if (const auto* why = std::get_if<std::string>(&drives)) {
    std::fprintf(stderr, "ligature-firmware: %s\n", why->c_str());
    return 2;
  }
  const int core = platform::realtime_core();
  const platform::Machine machine{"/", ip_details};
  auto checks = platform::check_machine(machine, core);
  for (const auto& interface : options.can) {
    for (auto& c : platform::check_can(machine, interface, core)) checks.push_back(std::move(c));
  }
  for (auto& c : std::get<0>(drives)) checks.push_back(std::move(c));
  std::printf("core of the loop: %d\n", core);
  std::fputs(table(checks).c_str(), stdout);
  std::fflush(stdout);
  std::vector<Check> measured;
  if (options.seconds > 0.0) {
    std::fprintf(stderr, "measuring wake-ups for %.0f s ..\n", options.seconds);
    const Latency latency = measure_wakeups(options.seconds, core);
    for (const auto& r : latency.refusals) measured.push_back({Grade::kFail, "rights", r, {}});
    measured.push_back(judge(latency.wakeup));
    std::fputs((histogram(latency.wakeup, latency.bins) + table(measured)).c_str(), stdout);
  }
  checks.insert(checks.end(), measured.begin(), measured.end());
  const auto count = [&](Grade g) { return std::ranges::count(checks, g, &Check::grade); };
  std::printf("%td OK, %td WARN, %td FAIL: %s\n", count(Grade::kOk), count(Grade::kWarn), count(Grade::kFail),
              count(Grade::kFail) > 0   ? "the rate cannot be promised on this machine"
              : count(Grade::kWarn) > 0 ? "the rate will be held most of the time"
                                        : "ready");
  return count(Grade::kFail) > 0 ? 3 : 0;
}

}  // namespace ligature::app
