#include "host/log_summary.hpp"

#include <limits>

#include "host/console/progress.hpp"
#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "host/thread_knot.hpp"
#include "protocol/scene/recorded_scene.hpp"

namespace ligature::host {
namespace {

class Summariser {
 public:
  Summariser(RigFacts facts, double knot_every_s) : knot_every_s_(knot_every_s) { summary.facts = std::move(facts); }

  void take(const LogEvent& event) {
    if (event.channel == kTicksChannel) {
      if (const auto batch = decode<ligature_msg::tick_batch_t>(event.data)) return take(*batch);
    } else if (event.channel == kThreadChannel) {
      if (const auto thread = decode<ligature_msg::thread_t>(event.data)) return take(*thread);
    } else if (event.channel == kStatusChannel) {
      if (auto status = decode<ligature_msg::status_t>(event.data)) {
        summary.last_status = std::move(status);
        return;
      }
    } else if (is_readable(event.channel, event.data)) {
      return;
    }
    ++summary.unreadable_messages;
  }

  /// Names the knot of the last shape, which the sampling interval may have left out.
  void finish() {
    if (last_shape_.count > 0) name(last_shape_);
  }

  LogSummary summary;

 private:
  void take(const ligature_msg::tick_batch_t& batch) {
    const int index = summary.tally.find_or_add(batch.session);
    if (index < 0) return summary.tally.leave_out(batch.ticks.size());
    if (index != session_) {
      session_ = index;
      next_knot_s_ = -std::numeric_limits<double>::infinity();  // the time starts again in another session
      summary.ticks.start_session(scene::split_recorded(summary.facts.scene_toml).samples_earliest_ns);
    }
    Session& session = summary.tally[index];
    session.ring_dropped = batch.ring_dropped;
    for (const auto& tick : batch.ticks)
      if (summary.tally.add(index, tick.tick, tick.state)) summary.ticks.add(tick);
  }

  void take(const ligature_msg::thread_t& thread) {
    ++summary.shapes;
    last_shape_ = thread;
    if (summary.facts.time_s(thread.tick) < next_knot_s_) return;
    next_knot_s_ = summary.facts.time_s(thread.tick) + knot_every_s_;
    name(thread);
  }

  void name(const ligature_msg::thread_t& thread) {
    knot::KnotResult knot = name_knot(thread);
    auto& knots = summary.knots;
    if (!knots.empty() && knots.back().type == knot.type && knots.back().handedness == knot.handedness) return;
    knots.push_back({summary.facts.time_s(thread.tick), std::move(knot.type), std::move(knot.handedness)});
  }

  double knot_every_s_;
  double next_knot_s_ = -std::numeric_limits<double>::infinity();
  int session_ = -1;
  ligature_msg::thread_t last_shape_{};
};

}  // namespace

double LogSummary::duration_s() const {
  std::int64_t periods = 0;
  for (const auto& session : tally.sessions())
    if (!session.ticks.is_empty()) periods += session.ticks.last() - session.ticks.first() + 1;
  return facts.time_s(periods);
}

double LogSummary::knot_first_s() const {
  for (const auto& span : knots)
    if (span.type == knots.back().type && span.handedness == knots.back().handedness) return span.from_s;
  return -1.0;
}

const KnotSpan* LogSummary::untied() const {
  return knots.size() > 1 && knots.back().type == "0_1" ? &knots[knots.size() - 2] : nullptr;
}

bool LogSummary::was_tied() const {
  return !knots.empty() && knots.back().type != "0_1" && knot_first_s() > knots.front().from_s;
}

LogSummary summarise(const std::string& log_path, double knot_every_s) {
  Summariser summariser(read_rig_facts(log_path), knot_every_s);
  console::Progress progress("reading");
  LogReader log(log_path, &progress);
  while (const LogEvent* event = log.next()) summariser.take(*event);
  summariser.finish();
  summariser.summary.damage = log.damage();
  if (summariser.summary.tally.received() == 0)
    throw BadInput(log_path + ": holds no readable tick; allowed: a log with messages on " +
                   std::string(kTicksChannel));
  return std::move(summariser.summary);
}

}  // namespace ligature::host
