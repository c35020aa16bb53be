#include "host/export_trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "host/atomic_file.hpp"
#include "host/errors.hpp"
#include "host/names.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

using Tick = ligature_msg::tick_t;
using Json = nlohmann::ordered_json;

/// Tracks of a session in the viewer. The numbers are the format's thread ids; the viewer sorts the tracks by them.
enum Track : int { kLoop = 1, kPhysics = 2, kBuses = 3, kEvents = 4 };

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// Nanoseconds as the format's microseconds, exactly.
std::string microseconds(std::int64_t ns) {
  const std::int64_t whole = std::abs(ns) / 1000, rest = std::abs(ns) % 1000;
  return (ns < 0 ? "-" : "") + std::to_string(whole) + '.' + std::to_string(1000 + rest).substr(1);
}

class TraceSink final : public ExportSink {
 public:
  TraceSink(const TraceTarget& target, const RigFacts& facts, const std::string& source)
      : file_(target.path),
        target_(target),
        source_(source),
        period_ns_(std::llround(facts.period_s * 1e9)),
        about_{{"source", source},
               {"scene_file", facts.scene_file},
               {"firmware_version", facts.firmware_version},
               {"host_version", LIGATURE_VERSION}} {
    file_.write("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n");
  }

  void add(const Tick& tick, double t_s, int session) override {
    first_s_ = std::min(first_s_, t_s);
    last_s_ = std::max(last_s_, t_s);
    if (t_s < target_.from_s || t_s > target_.to_s) return;
    if (named_.insert(session).second) name_tracks(session);
    session_ = session;
    zero_ns_ = tick.scheduled_ns - tick.tick * period_ns_;
    if ((tick.flags & Tick::FLAG_PERIOD_LOST) != 0) {
      slice(kLoop, "period lost", tick.scheduled_ns, period_ns_, {{"tick", tick.tick}});
      return;
    }
    add_loop(tick);
    add_physics(tick);
    add_buses(tick);
  }

  void add(const ligature_msg::event_t& event, double t_s) override {
    if (t_s < target_.from_s || t_s > target_.to_s || session_ == 0) return;
    write({{"name", event.text}, {"ph", "i"}, {"s", "p"}, {"pid", session_}, {"tid", static_cast<int>(kEvents)}},
          zero_ns_ + event.tick * period_ns_, "",
          Json{{"tick", event.tick}, {"kind", event.kind}, {"code", event.code}});
  }

  void check() const override {
    if (named_.empty())
      throw BadInput(text("--trace-span: found %g .. %g s, where %s has no tick; allowed a part of %.3f .. %.3f s",
                          target_.from_s, target_.to_s, source_.c_str(), first_s_, last_s_));
  }

  void commit() override {
    about_["notes"] = notes_;
    file_.write("\n],\"otherData\":" + text_of(about_) + "}\n");
    file_.commit();
  }

 private:
  void add_loop(const Tick& tick) {
    const std::int64_t awake = tick.scheduled_ns + tick.wakeup_latency_ns;
    slice(kLoop, "wake-up", tick.scheduled_ns, tick.wakeup_latency_ns, {});
    const Json about{{"tick", tick.tick}, {"state", state_name(tick.state)}, {"flags", tick.flags}};
    const bool is_missed = (tick.flags & Tick::FLAG_DEADLINE_MISSED) != 0;
    slice(kLoop, is_missed ? "tick, too late" : "tick", awake, tick.execution_ns, about);
    std::int64_t begin = 0;
    for (const auto& [name, end] :
         std::array<std::pair<const char*, std::int64_t>, 5>{{{"SYNC", tick.sync_ns},
                                                              {"wait for joints", tick.tpdo_ns},
                                                              {"coupling and limits", tick.law_ns},
                                                              {"send torques", tick.control_ns},
                                                              {"hand over to physics", tick.execution_ns}}}) {
      if (end > begin) slice(kLoop, name, awake + begin, end - begin, {});
      begin = std::max(begin, end);
    }
  }

  /// The physics of the thread begins when the loop has passed it the tools, and may end in the next period.
  void add_physics(const Tick& tick) {
    if (tick.thread_done_ns <= 0) return;  // not finished in time: its times are not known
    const std::int64_t awake = tick.scheduled_ns + tick.wakeup_latency_ns;
    const std::int64_t wake_up = tick.thread_start_ns - tick.execution_ns;
    if (wake_up > 0) slice(kPhysics, "wake-up", awake + tick.execution_ns, wake_up, {});
    constexpr std::array<const char*, 3> kEnds{"physics", "physics, ended by work", "physics, ended by the clock"};
    const auto end = static_cast<std::size_t>(std::clamp<int>(tick.thread_end, 0, 2));
    slice(kPhysics, kEnds[end], awake + tick.thread_start_ns, tick.thread_done_ns - tick.thread_start_ns,
          {{"tick", tick.tick}, {"cpu_us", tick.thread_work_ns / 1e3}, {"contacts", tick.contacts}});
  }

  /// The recording has no time of single messages: only when SYNC went out, when the last answer came, and how long
  /// each bus was busy.
  void add_buses(const Tick& tick) {
    const std::int64_t awake = tick.scheduled_ns + tick.wakeup_latency_ns;
    slice(kBuses, "SYNC until the last joint message", awake + tick.sync_ns, tick.tpdo_ns - tick.sync_ns, {});
    slice(kBuses, "torques", awake + tick.law_ns, tick.control_ns - tick.law_ns, {});
    write({{"name", "bus load"}, {"ph", "C"}, {"pid", session_}}, tick.scheduled_ns, "",
          Json{{kHandNames[0], finite(tick.bus_load[0])}, {kHandNames[1], finite(tick.bus_load[1])}});
  }

  static double finite(double value) { return std::isfinite(value) ? value : 0.0; }

  void name_tracks(int session) {
    const auto name = [&](const char* what, int track, const std::string& text) {
      Json head{{"name", what}, {"ph", "M"}, {"pid", session}};
      if (track > 0) head["tid"] = track;
      write(head, 0, "", Json{{"name", text}});
    };
    name("process_name", 0, "ligature-firmware, run " + std::to_string(session) + " of the recording");
    name("thread_name", kLoop, "real-time loop");
    name("thread_name", kPhysics, "physics of the thread");
    name("thread_name", kBuses, "CAN buses");
    name("thread_name", kEvents, "events");
  }

  void slice(Track track, const char* name, std::int64_t begin_ns, std::int64_t length_ns, const Json& about) {
    if (length_ns < 0) return;
    write({{"name", name}, {"ph", "X"}, {"pid", session_}, {"tid", static_cast<int>(track)}}, begin_ns,
          microseconds(length_ns), about);
  }

  /// @param head name, phase and track of the event; times and arguments are added.
  void write(const Json& head, std::int64_t at_ns, const std::string& length_us, const Json& about) {
    std::string line = text_of(head);
    line.pop_back();  // the closing brace
    line += R"(,"ts":)" + microseconds(at_ns);
    if (!length_us.empty()) line += R"(,"dur":)" + length_us;
    if (!about.empty()) line += R"(,"args":)" + text_of(about);
    file_.write((is_first_ ? "" : ",\n") + line + '}');
    is_first_ = false;
  }

  AtomicFile file_;
  TraceTarget target_;
  std::string source_;
  std::int64_t period_ns_, zero_ns_ = 0;
  // times of all ticks, also of those outside the span
  double first_s_ = std::numeric_limits<double>::infinity(), last_s_ = -first_s_;
  Json about_;
  int session_ = 0;
  std::set<int> named_;
  bool is_first_ = true;
};

}  // namespace

std::unique_ptr<ExportSink> make_trace_sink(const TraceTarget& target, const RigFacts& facts,
                                            const std::string& source) {
  return std::make_unique<TraceSink>(target, facts, source);
}

}  // namespace ligature::host
