#include "firmware/app/summary.hpp"

#include <cstdio>

namespace ligature::app {
namespace {

std::string row(const char* what, const rt::DurationStatistics& s) {
  char line[96];
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  std::snprintf(line, sizeof line, "  %-10s %9.1f %9.1f %9.1f\n", what, us(s.quantile_ns(0.5)), us(s.quantile_ns(0.99)),
                us(s.max_ns()));
  return line;
}

std::string recorder_rows(const Losses& losses) {
  if (!losses.recorder) return {};
  char rows[128];
  std::snprintf(rows, sizeof rows, "  not recorded     %10lld\n  slowest sync     %10lld ms\n",
                static_cast<long long>(losses.flight), static_cast<long long>(losses.slowest_sync.count()));
  return rows;
}

}  // namespace

std::string summary(const rt::CycleTiming& t, std::int64_t periods, const Losses& losses) {
  const auto executed = t.execution.count();
  const double held_Hz = periods > 0 ? 1000.0 * static_cast<double>(executed) / static_cast<double>(periods) : 0.0;
  char head[640];
  std::snprintf(head, sizeof head,
                "control loop, 1 kHz\n"
                "  rate held        %10.2f Hz  (%llu of %lld periods executed)\n"
                "  deadline misses  %10llu  (%llu by the loop's own work)\n"
                "  periods lost     %10llu\n"
                "  thread late      %10llu\n"
                "  thread cut       %10llu  (by the clock; in all it stood still for %.1f ms)\n"
                "  records dropped  %10llu\n",
                held_Hz, static_cast<unsigned long long>(executed), static_cast<long long>(periods),
                static_cast<unsigned long long>(t.deadline_misses), static_cast<unsigned long long>(t.overworked),
                static_cast<unsigned long long>(t.periods_lost), static_cast<unsigned long long>(t.thread_late),
                static_cast<unsigned long long>(t.thread_cut), t.thread_lost_ticks,
                static_cast<unsigned long long>(losses.telemetry));
  return head + recorder_rows(losses) + "  us               p50       p99       max\n" + row("wakeup", t.wakeup) +
         row("control", t.control) + row("execution", t.execution) + row("CPU", t.work) + row("thread CPU", t.thread);
}

}  // namespace ligature::app
