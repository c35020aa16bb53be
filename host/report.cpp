#include "host/report.hpp"

#include <nlohmann/json.hpp>

#include "host/knot/common_name.hpp"
#include "host/names.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

using Json = nlohmann::ordered_json;
using Count = long long;

/// Samples received per second of the run.
double recorded_per_s(const LogSummary& s) { return static_cast<double>(s.tally.received()) / s.duration_s(); }

/// First recorded tick of the first session. Ticks before the recorder was started do not count as lost.
std::int64_t first_tick(const LogSummary& s) { return s.tally.sessions().front().ticks.first(); }

/// Whether the number of lost ticks is certain: every tick was counted in a session, and every session has its end
/// recorded.
bool all_is_known(const LogSummary& s) { return s.tally.left_out() == 0 && s.tally.open_ended() == nullptr; }

const char* lost_words(const LogSummary& s) { return all_is_known(s) ? "lost" : "known to be lost"; }

/// Share of the recorded periods in which the loop ran, in %.
double executed_percent(const LogSummary& s) {
  return 100.0 * static_cast<double>(s.ticks.executed()) / static_cast<double>(s.tally.received());
}

/// Rate of the loop, computed from recorded ticks only: a sample lost on the network does not reduce this rate.
double rate_held_per_s(const LogSummary& s) { return executed_percent(s) / 100.0 / s.facts.period_s; }

std::string row(const char* name, const std::string& value) { return text("  %-18s %s\n", name, value.c_str()); }

std::string duration_row(const char* name, const Percentiles& p) {
  return row(name, text("p50 %.1f us   p99 %.1f us   max %.1f us", p.p50_ns * 1e-3, p.p99_ns * 1e-3, p.max_ns * 1e-3));
}

std::string hand_row(const LogSummary& s, std::size_t hand) {
  const auto& felt = s.ticks.hands()[hand];
  std::string value = text("peak %.3f N", felt.peak_N);
  if (felt.peak_tick >= 0) value += text(" at %.3f s", s.facts.time_s(felt.peak_tick));
  value += text(", mean %.3f N over %.2f s of grasp", felt.mean_N(), s.facts.time_s(felt.grasp_ticks));
  if (felt.limited_ticks > 0) value += text(", at the limit for %.3f s", s.facts.time_s(felt.limited_ticks));
  return row(text("force %s", std::string(kHandNames[hand]).c_str()).c_str(), value);
}

std::string knot_words(const LogSummary& s) {
  if (s.knots.empty()) return "no shape recorded";
  if (const auto* before = s.untied())
    return text("0_1 (no knot); untied at %.2f s, before that %s", s.knot_since_s(),
                knot::full_name(before->type, before->handedness).c_str());
  const auto& last = s.knots.back();
  if (last.type == "0_1") return "0_1 (no knot)";
  std::string words = knot::full_name(last.type, last.handedness);
  words += text(s.was_tied() ? "; first tied at %.2f s" : "; there in the first recorded shape, at %.2f s",
                s.knot_first_s());
  if (s.knot_since_s() > s.knot_first_s()) words += text(", unchanged since %.2f s", s.knot_since_s());
  return words;
}

std::string thread_words(const LogSummary& s) {
  const ThreadStatistics& t = s.ticks.thread();
  const double share = s.ticks.executed() > 0 ? t.lost_ticks / static_cast<double>(s.ticks.executed()) : 0.0;
  return text("stood still for %.3f s (%.2f %% of the time); ticks ended by work %lld, by the clock %lld, late %lld",
              t.lost_ticks * s.facts.period_s, 100.0 * share, static_cast<Count>(t.by_work),
              static_cast<Count>(t.by_clock), static_cast<Count>(t.late));
}

std::string thread_time_words(const LogSummary& s) {
  const ThreadTime& t = s.ticks.thread_time();
  if (!t.known()) return "not known: no two periods follow each other";
  return text("p50 %.0f us a period; at least %.0f us in 99 %% of the periods, %.0f us in all",
              t.at_least_ns(50) * 1e-3, t.at_least_ns(99) * 1e-3, t.at_least_ns(100) * 1e-3);
}

std::string fault_words(const LogSummary& s) {
  if (s.ticks.faults().empty()) return "none";
  std::string words;
  for (const auto& entry : s.ticks.faults())
    words += text("%s%d at %.3f s", words.empty() ? "" : ", ", entry.fault, s.facts.time_s(entry.tick));
  return words;
}

Json microseconds(const Percentiles& p) {
  return {{"p50", p.p50_ns * 1e-3}, {"p99", p.p99_ns * 1e-3}, {"max", p.max_ns * 1e-3}};
}

}  // namespace

std::string report_table(const LogSummary& s) {
  std::string table = text("run of %.3f s", s.duration_s());
  if (s.facts.has_status)
    table += text(", scene %s, firmware %s", s.facts.scene_file.c_str(), s.facts.firmware_version.c_str());
  table += '\n';
  const auto received = s.tally.received(), missing = s.tally.missing();
  table += row("samples", text("%lld recorded, %lld %s, %.1f per second", static_cast<Count>(received),
                               static_cast<Count>(missing), lost_words(s), recorded_per_s(s)));
  table += row("rate held",
               text("%.1f ticks per second, %.3f %% of periods executed", rate_held_per_s(s), executed_percent(s)));
  table += row("deadline misses", text("%lld finished late", static_cast<Count>(s.ticks.deadline_misses())));
  table += row("periods lost", text("%lld skipped whole", static_cast<Count>(s.ticks.periods_lost())));
  table += duration_row("wake-up latency", s.ticks.wakeup());
  table += duration_row("control time", s.ticks.control());
  table += duration_row("execution time", s.ticks.execution());
  table += row("thread", thread_words(s));
  table += row("time for thread", thread_time_words(s));
  for (std::size_t hand = 0; hand < 2; ++hand) table += hand_row(s, hand);
  table += row("force limit", text("%.2f N", s.facts.max_force_N));
  table += row("faults", fault_words(s));
  table += row("knot", knot_words(s));
  if (const auto first = first_tick(s); first > 1)
    table += row("joined late", text("recording begins at tick %lld", static_cast<Count>(first)));
  if (const Session* open = s.tally.open_ended())
    table += row("open end",
                 text("recording ends at tick %lld in %s, not with the drives switched off: what came after "
                      "is not in it; the flight recorder may have it",
                      static_cast<Count>(open->ticks.last()), std::string(state_name(open->last_state)).c_str()));
  if (s.tally.are_interleaved())
    table += row("sessions", text("%zu at the same time", s.tally.sessions().size()));
  else if (s.tally.restarts() > 0)
    table += row("restarts", text("%zu of the firmware", s.tally.restarts()));
  if (s.tally.duplicates() > 0)
    table += row("duplicates", text("%lld ticks", static_cast<Count>(s.tally.duplicates())));
  if (s.tally.left_out() > 0)
    table += row("not counted", text("%lld ticks of further sessions: more than %zu are forged or garbage",
                                     static_cast<Count>(s.tally.left_out()), SessionTally::kMaxSessions));
  if (s.unreadable_messages > 0)
    table += row("unreadable", text("%lld messages", static_cast<Count>(s.unreadable_messages)));
  if (!s.damage.empty()) table += row("log damaged", s.damage);
  if (s.last_status && !s.last_status->realtime)
    table += row("real time", "not granted: SCHED_FIFO or locked memory was refused, so timing is best effort");
  return table;
}

std::string report_json(const LogSummary& s) {
  Json hands, faults = Json::array(), history = Json::array(), knot = nullptr;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const auto& felt = s.ticks.hands()[hand];
    hands[std::string(kHandNames[hand])] = {
        {"peak_N", felt.peak_N},
        {"peak_s", felt.peak_tick < 0 ? Json(nullptr) : Json(s.facts.time_s(felt.peak_tick))},
        {"mean_N", felt.mean_N()},
        {"grasp_s", s.facts.time_s(felt.grasp_ticks)},
        {"limited_ticks", felt.limited_ticks}};
  }
  for (const auto& entry : s.ticks.faults())
    faults.push_back({{"t_s", s.facts.time_s(entry.tick)}, {"fault", entry.fault}});
  for (const auto& span : s.knots) history.push_back({span.from_s, span.type});
  if (!s.knots.empty()) {
    const auto& last = s.knots.back();
    const auto common = knot::common_name(last.type, last.handedness);
    knot = {{"type", last.type},
            {"handedness", last.handedness},
            {"first_tied_s", s.was_tied() ? Json(s.knot_first_s()) : Json(nullptr)},
            {"untied_s", s.untied() != nullptr ? Json(s.knot_since_s()) : Json(nullptr)},
            {"unchanged_since_s", s.knot_since_s()},
            {"common_name", common.empty() ? Json(nullptr) : Json(common)}};
  }
  const Json json = {{"duration_s", s.duration_s()},
                     {"scene", s.facts.scene_file},
                     {"firmware_version", s.facts.firmware_version},
                     {"ticks_recorded", s.tally.received()},
                     {"ticks_lost", s.tally.missing()},
                     {"ticks_not_counted", s.tally.left_out()},
                     {"ended", s.tally.open_ended() == nullptr},
                     {"first_tick", first_tick(s)},
                     {"duplicates", s.tally.duplicates()},
                     {"restarts", s.tally.restarts()},
                     {"unreadable_messages", s.unreadable_messages},
                     {"recorded_per_s", recorded_per_s(s)},
                     {"executed_per_s", rate_held_per_s(s)},
                     {"executed_percent", executed_percent(s)},
                     {"deadline_misses", s.ticks.deadline_misses()},
                     {"periods_lost", s.ticks.periods_lost()},
                     {"thread",
                      {{"stood_still_s", s.ticks.thread().lost_ticks * s.facts.period_s},
                       {"ended_by_work", s.ticks.thread().by_work},
                       {"ended_by_clock", s.ticks.thread().by_clock},
                       {"late", s.ticks.thread().late},
                       {"time_us",
                        {{"p50", s.ticks.thread_time().at_least_ns(50) * 1e-3},
                         {"p1", s.ticks.thread_time().at_least_ns(99) * 1e-3},
                         {"min", s.ticks.thread_time().at_least_ns(100) * 1e-3}}}}},
                     {"wakeup_us", microseconds(s.ticks.wakeup())},
                     {"control_us", microseconds(s.ticks.control())},
                     {"execution_us", microseconds(s.ticks.execution())},
                     {"hand_force", hands},
                     {"max_force_N", s.facts.max_force_N},
                     {"faults", faults},
                     {"knot", knot},
                     {"knot_history", history},
                     {"damage", s.damage}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ligature::host
