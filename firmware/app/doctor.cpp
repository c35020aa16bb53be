#include "firmware/app/doctor.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "firmware/app/admission.hpp"
#include "firmware/app/doctor/can_echo.hpp"
#include "firmware/app/doctor/file_text.hpp"
#include "firmware/app/doctor/hwlat.hpp"
#include "firmware/app/doctor/load.hpp"
#include "firmware/app/doctor/report.hpp"
#include "firmware/app/doctor/report_file.hpp"
#include "firmware/app/doctor/timerlat.hpp"
#include "firmware/app/drive_checks.hpp"
#include "firmware/app/rig_setup.hpp"
#include "firmware/platform/core_checks.hpp"
#include "firmware/platform/idle_guard.hpp"
#include "firmware/platform/monotonic_clock.hpp"
#include "firmware/platform/realtime.hpp"
#include "protocol/device/device_file.hpp"

namespace ligature::app {
namespace {

using platform::Check;
using platform::Grade;

constexpr auto kPeriod = std::chrono::milliseconds(1);
constexpr std::int64_t kGood_ns = 100'000, kUsable_ns = 300'000;
constexpr double kGaps_s = 600.0;    // longest search for gaps that the machine's firmware makes
constexpr double kCulprit_s = 60.0;  // longest search for what delays wake-ups
// rtla 6.12 does not tell of a late wake-up if its time is over before it has read the trace
constexpr double kLeastCulprit_s = 10.0;
constexpr std::size_t kBins = 12;  // upper bounds 1, 2, 4, .. 1024 us, and one bin for longer

/// Output of a shell command. `interface` was validated before, so it cannot inject shell syntax.
std::string ip_details(const std::string& interface) {
  const std::string command = "ip -details link show " + interface + " 2>/dev/null";
  // NOLINTNEXTLINE(bugprone-command-processor): the text is ours, apart from the name that was checked
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 512> part;
  while (pipe && std::fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

struct Latency {
  rt::DurationStatistics wakeup;
  LatencyHistogram fine;
  std::vector<std::uint64_t> bins = std::vector<std::uint64_t>(kBins);
  std::array<LateWakeUp, 10> worst{};  // latest first
  double seconds = 0.0;
  platform::Refusals refusals;

  void add(std::int64_t late_ns, double at_s) noexcept {
    wakeup.add(late_ns);
    fine.add(late_ns);
    const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(late_ns, 0)) / 1000;
    ++bins[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(us)), kBins - 1)];
    LateWakeUp one{at_s, 1e-3 * static_cast<double>(late_ns)};
    for (auto& place : worst)
      if (one.late_us > place.late_us) std::swap(one, place);
  }
};

std::atomic<bool> g_stop{false};

/// Wakes up every millisecond like the loop, with the same priority and locked memory, and does no other work.
Latency measure_wakeups(double seconds, int core) {
  Latency result;
  result.refusals = platform::lock_memory();
  std::thread([&] {
    for (const auto& r : platform::make_realtime(core)) result.refusals.push_back(r);
    platform::MonotonicClock clock;
    const auto begin = clock.now();
    auto due = begin + kPeriod;
    const auto end = due + std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
    for (; due < end && !g_stop; due += kPeriod) {
      clock.sleep_until(due);
      const auto late = clock.now() - due;
      result.add(late.count(), std::chrono::duration<double>(due - begin).count());
      due += late / kPeriod * kPeriod;  // lost periods are skipped, as in the loop
    }
    result.seconds = std::chrono::duration<double>(due - begin).count();
  }).join();
  return result;
}

std::string cpu_name() {
  const std::string text = file_text("/proc/cpuinfo");
  const auto at = text.find("model name");
  if (at == std::string::npos) return "not known";
  const auto from = text.find(':', at) + 2;
  return text.substr(from, text.find('\n', from) - from);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

/// Name of the scene in which every key has its default value: one of the paper's models.
constexpr const char* kDefaultScene = "default scene";

std::variant<Plan, Refusal> plan_for(const DoctorOptions& options) {
  if (options.scene.empty()) {
    if (options.device.empty()) return plan_of(kDefaultScene, "[suture]\n", {});
    const auto device = device::load_device(options.device);
    if (const auto* error = std::get_if<scene::Error>(&device)) return Refusal{2, error->text};
    return plan_of(kDefaultScene, "[suture]\n", {}, std::get<device::Device>(device));
  }
  RunOptions like_run;
  like_run.scene = options.scene;
  like_run.device = options.device;
  like_run.watchdog_ms = options.watchdog_ms;
  like_run.accept_no_drive_watchdog = true;  // nothing is moved here
  return make_plan(like_run);
}

/// How late the loop may wake up with a scene (Admission::slack_us).
struct Slack {
  double us = 0.0;
  std::string problem = {};  ///< why the time of the CAN drivers is not counted; empty: it is, or none was named
};

/// An acceptance test also counts the time of the CAN drivers.
std::variant<Slack, Refusal> slack_of(const DoctorOptions& options, int core) {
  const auto planned = plan_for(options);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) return *refusal;
  const auto& plan = std::get<Plan>(planned);
  AdmissionSettings settings;
  settings.core = core;
  settings.device = plan.device;
  Slack slack;
  if (options.is_acceptance()) {
    const auto drivers = measure_drivers(options.can, plan.device);
    if (const auto* known = std::get_if<DriverTime>(&drivers)) settings.driver = *known;
    if (const auto* why = std::get_if<std::string>(&drivers)) slack.problem = *why;
  }
  slack.us = admit(plan.scene, settings).slack_us();
  return slack;
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f s", seconds);
  return text;
}

Check gaps_row(const std::string& found) {
  constexpr const char* kWhat = "hardware gaps";
  if (found.starts_with("none")) return {Grade::kOk, kWhat, found, {}};
  if (found.starts_with("gaps"))
    return {Grade::kWarn, kWhat, found,
            "BIOS: power management and SMI sources off; or a board made for real-time use"};
  return {Grade::kWarn, kWhat, found, "run this as root on a kernel with CONFIG_HWLAT_TRACER"};
}

/// Not graded: the row of the wake-ups is.
Check culprit_row(const std::string& found) {
  const bool is_known = !found.starts_with("not looked for");
  return {Grade::kOk, "latest wake-up", found,
          is_known ? "" : "apt install rtla; then run this as root on a kernel with CONFIG_TIMERLAT_TRACER"};
}

Check echo_row(const CanEcho& echo) {
  if (!echo.problem.empty())
    return {Grade::kFail, "CAN round trip", echo.interface + ": " + echo.problem,
            "see the rows of this interface above"};
  const unsigned long long lost = echo.lost, sent = lost + echo.round_trips.count();
  char found[160];
  std::snprintf(found, sizeof found, "%s: p50 %.0f, p99.9 %.0f, worst %.0f us; %llu of %llu lost",
                echo.interface.c_str(), echo.round_trips.quantile_us(0.5), echo.round_trips.quantile_us(0.999),
                echo.round_trips.max_us(), lost, sent);
  if (echo.lost > 0)
    return {Grade::kFail, "CAN round trip", found, "cable, termination, and another node that is switched on"};
  return {Grade::kOk, "CAN round trip", found, {}};
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
          "mend the rows above, take other work off this machine; the row 'latest wake-up' of an acceptance test names "
          "the culprit"};
}

Check judge(const LatencyHistogram& wakeup, double slack_us) {
  const auto late = wakeup.from(slack_us);
  char found[160];
  std::snprintf(found, sizeof found, "worst %.0f us, p99.99 %.0f; %llu of %llu later than the scene's %.0f us",
                wakeup.max_us(), wakeup.quantile_us(0.9999), static_cast<unsigned long long>(late),
                static_cast<unsigned long long>(wakeup.count()), slack_us);
  constexpr const char* kWhat = "wake-up, this scene";
  if (wakeup.max_us() < slack_us / 2) return {Grade::kOk, kWhat, found, {}};
  return {wakeup.max_us() < slack_us ? Grade::kWarn : Grade::kFail, kWhat, found,
          "mend the rows above, take other work off this machine; the row 'latest wake-up' of an acceptance test names "
          "the culprit"};
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

namespace {

/// The checks that take time: hardware, CAN, wake-ups. Adds their rows to the report and prints them.
void measure(const DoctorOptions& options, DoctorReport& report) {
  std::vector<Check> rows;
  std::optional<Load> load;
  const double gaps_s = std::min(options.duration_s(), std::clamp(options.duration_s() / 60.0, 10.0, kGaps_s));
  if (options.load) {
    load.emplace(options.duration_s() + gaps_s + kCulprit_s + 10.0 * static_cast<double>(options.can.size()) + 1.0);
    report.load = load->kinds();
  }
  if (options.is_acceptance()) {
    std::fprintf(stderr, "looking for gaps that the machine's firmware makes, for %.0f s at most ..\n", gaps_s);
    report.hardware = look_for_gaps("/sys/kernel/tracing", gaps_s, g_stop);
    rows.push_back(gaps_row(report.hardware));
  }
  if (options.is_acceptance())
    for (const auto& interface : options.can) {
      report.can.push_back(measure_echo(interface, std::min(10.0, options.duration_s())));
      rows.push_back(echo_row(report.can.back()));
    }
  std::fprintf(stderr, "measuring wake-ups for %.0f s%s ..\n", options.duration_s(), load ? " under load" : "");
  const platform::IdleGuard awake;  // as in a run
  const Latency latency = measure_wakeups(options.duration_s(), report.core);
  if (load && load->running() < static_cast<int>(report.load.size()))
    rows.push_back({Grade::kWarn, "load", "a part of the load ended before the measurement", {}});
  if (g_stop)
    rows.push_back({Grade::kWarn, "measured",
                    seconds_text(latency.seconds) + " of " + seconds_text(options.duration_s()),
                    "let it run to its end"});
  report.wakeup = latency.fine;
  report.seconds = latency.seconds;
  for (const auto& late : latency.worst)
    if (late.late_us > 0.0) report.worst.push_back(late);
  std::vector<Check> culprit;
  if (options.is_acceptance() && !g_stop) {
    // As late as half of the worst: that will happen again soon
    const double least_us = latency.fine.max_us() / 2;
    const double seconds = std::clamp(options.duration_s(), kLeastCulprit_s, kCulprit_s);
    std::fprintf(stderr, "looking for what delays a wake-up by %.0f us, for %.0f s at most ..\n", least_us, seconds);
    culprit.push_back(culprit_row(look_for_culprit(report.core, platform::kLoopPriority, least_us, seconds)));
  }
  for (const auto& r : latency.refusals) rows.push_back({Grade::kFail, "rights", r, {}});
  rows.push_back(report.slack_us ? judge(latency.fine, *report.slack_us) : judge(latency.wakeup));
  rows.insert(rows.end(), culprit.begin(), culprit.end());
  std::fputs((histogram(latency.wakeup, latency.bins) + table(rows)).c_str(), stdout);
  report.checks.insert(report.checks.end(), rows.begin(), rows.end());
}

int compare_files(const std::vector<std::string>& files) {
  std::vector<DoctorReport> reports;
  for (const auto& file : files) {
    const std::string text = file_text(file);
    auto read = report_of(text);
    if (const auto* why = std::get_if<std::string>(&read)) {
      std::fprintf(stderr, "ligature-firmware: %s: %s\n", file.c_str(), text.empty() ? "cannot be read" : why->c_str());
      return 2;
    }
    reports.push_back(std::get<DoctorReport>(std::move(read)));
  }
  std::fputs(compare(reports[0], files[0], reports[1], files[1]).c_str(), stdout);
  return 0;
}

}  // namespace

int doctor(const DoctorOptions& options) {
  if (!options.compare.empty()) return compare_files(options.compare);
  // before the measurement, which may take hours
  const auto objection = options.report.empty() ? std::string() : objection_to_report(options.report);
  if (!objection.empty()) {
    std::fprintf(stderr, "ligature-firmware: --report %s: %s\n", options.report.c_str(), objection.c_str());
    return 2;
  }
  struct sigaction action {};
  action.sa_handler = [](int) { g_stop = true; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::variant<std::vector<Check>, std::string> drives;
  if (!options.device.empty()) drives = drive_checks(options.device, options.watchdog_ms);
  if (const auto* why = std::get_if<std::string>(&drives)) {
    std::fprintf(stderr, "ligature-firmware: %s\n", why->c_str());
    return 2;
  }
  DoctorReport report;
  report.core = platform::realtime_core();
  report.cores = static_cast<int>(std::thread::hardware_concurrency());
  report.started = utc_now();
  report.kernel = file_text("/proc/sys/kernel/osrelease");
  if (!report.kernel.empty()) report.kernel.pop_back();  // the line's end
  report.cpu = cpu_name();
  report.ligature = LIGATURE_VERSION;
  report.scene = options.scene.empty() && options.is_acceptance() ? kDefaultScene : options.scene;
  std::string drivers_problem;
  if (!options.scene.empty() || options.is_acceptance()) {
    const auto slack = slack_of(options, report.core);
    if (const auto* refusal = std::get_if<Refusal>(&slack)) {
      std::fprintf(stderr, "ligature-firmware: %s\n", refusal->text.c_str());
      return refusal->exit_code;
    }
    report.slack_us = std::get<Slack>(slack).us;
    drivers_problem = std::get<Slack>(slack).problem;
  }
  const platform::Machine machine{"/", ip_details};
  report.checks = platform::check_machine(machine, report.core);
  for (auto& c : platform::check_core(machine, report.core)) report.checks.push_back(std::move(c));
  const bool fd = !options.device.empty() && need_fd(options.device);
  for (const auto& interface : options.can)
    for (auto& c : platform::check_can(machine, interface, report.core, fd)) report.checks.push_back(std::move(c));
  for (auto& c : std::get<0>(drives)) report.checks.push_back(std::move(c));
  if (!drivers_problem.empty())
    report.checks.push_back({Grade::kFail, "CAN drivers' time", drivers_problem, "mend the rows of this interface"});
  std::printf("core of the loop: %d\n", report.core);
  std::fputs(table(report.checks).c_str(), stdout);
  std::fflush(stdout);
  if (options.duration_s() > 0.0) measure(options, report);
  const auto count = [&](Grade g) { return std::ranges::count(report.checks, g, &Check::grade); };
  report.verdict = count(Grade::kFail) > 0   ? "the rate cannot be promised on this machine"
                   : count(Grade::kWarn) > 0 ? "the rate will be held most of the time"
                                             : "ready";
  std::printf("%td OK, %td WARN, %td FAIL: %s\n", count(Grade::kOk), count(Grade::kWarn), count(Grade::kFail),
              report.verdict.c_str());
  if (!options.report.empty() && !write_report(options.report, report)) {
    std::fprintf(stderr, "ligature-firmware: --report %s: cannot be written\n", options.report.c_str());
    return 3;
  }
  return count(Grade::kFail) > 0 ? 3 : 0;
}

}  // namespace ligature::app
