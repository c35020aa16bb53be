#include "host/recording_reader.hpp"

#include <algorithm>
#include <string_view>

#include "host/errors.hpp"
#include "host/flight_reader.hpp"
#include "host/log_reader.hpp"
#include "host/session_tally.hpp"
#include "host/tick_order.hpp"

namespace ligature::host {
namespace {

constexpr std::string_view kNotesChannel = "LIGATURE_NOTES";

/// Passes messages to the sinks: each tick once, in order.
class Walk {
 public:
  Walk(const RigFacts& facts, std::span<ExportSink* const> sinks) : facts_(facts), sinks_(sinks) {}

  void take(const LogEvent& event) {
    if (event.channel == kTicksChannel) {
      if (const auto batch = decode<ligature_msg::tick_batch_t>(event.data)) return take(*batch);
    } else if (event.channel == kThreadChannel) {
      if (const auto thread = decode<ligature_msg::thread_t>(event.data)) return take(*thread);
    } else if (event.channel == kEventChannel) {
      if (const auto message = decode<ligature_msg::event_t>(event.data)) return tell(*message, message->tick);
    } else if (event.channel == kStatusChannel) {
      if (const auto status = decode<ligature_msg::status_t>(event.data)) return take(*status);
    } else if (event.channel == kNotesChannel) {
      for (auto* sink : sinks_) sink->note({reinterpret_cast<const char*>(event.data.data()), event.data.size()});
      return;
    } else if (is_readable(event.channel, event.data)) {
      return;
    }
    ++result_.unreadable_messages;
  }

  void take(const ligature_msg::tick_batch_t& batch) {
    const int session = tally_.find_or_add(batch.session);
    if (session < 0) return tally_.leave_out(batch.ticks.size());
    if (session != session_) end_session();
    session_ = session;
    for (const auto& tick : batch.ticks) {
      if (tally_[session].ticks.add(tick.tick))
        order_.add(tick, [this](const auto& t) { write(t); });
      else
        ++result_.duplicates_left_out;
    }
  }

  void take(const ligature_msg::status_t& status) {
    if (status.scene_toml == scene_toml_ && status.scene_file == scene_file_) return;
    scene_toml_ = status.scene_toml;
    scene_file_ = status.scene_file;
    tell(status, status.scene_first_tick);
  }

  ExportResult finish() {
    end_session();
    name_missing();
    return result_;
  }

  [[nodiscard]] bool has_ticks() const { return tally_.received() > 0; }

 private:
  void end_session() {
    order_.flush([this](const auto& t) { write(t); });
  }

  void write(const ligature_msg::tick_t& tick) {
    ++result_.tick_rows;
    result_.has_grasp |= tick.grasped_node[0] >= 0 || tick.grasped_node[1] >= 0;
    for (auto* sink : sinks_) sink->add(tick, facts_.time_s(tick.tick), session_ + 1);
  }

  void name_missing() {
    constexpr std::size_t kNamed = 10;
    std::size_t named = 0;
    result_.left_out = tally_.left_out();
    for (const Session& session : tally_.sessions()) {
      result_.missing += session.ticks.missing();
      for (const TickRange& hole : session.ticks.missing_ranges()) {
        if (++named > kNamed) break;
        if (named > 1) result_.missing_ticks += ", ";
        result_.missing_ticks += std::to_string(hole.first);
        if (hole.size() > 1) result_.missing_ticks += ".." + std::to_string(hole.last);
      }
    }
    if (named > kNamed) result_.missing_ticks += ", ..";
  }

  template <class Message>
  void tell(const Message& message, std::int64_t tick) {
    for (auto* sink : sinks_) sink->add(message, facts_.time_s(tick));
  }

  void take(const ligature_msg::thread_t& thread) {
    ++result_.shapes;
    tell(thread, thread.tick);
  }

  const RigFacts& facts_;
  std::span<ExportSink* const> sinks_;
  std::string scene_file_, scene_toml_;
  SessionTally tally_;
  TickOrder order_;
  int session_ = -1;
  ExportResult result_;
};

/// The scene in force at a tick, as the status message that a log would contain.
ligature_msg::status_t status_of(const FlightReader& recorder, std::int64_t tick) {
  const auto& scene = recorder.scene_at(tick);
  ligature_msg::status_t status{};
  status.session = recorder.session();
  status.protocol_version = ligature_msg::status_t::VERSION;
  status.tick = std::max(tick, scene.first_tick);
  status.scene_first_tick = scene.first_tick;
  status.firmware_version = scene.facts.firmware_version;
  status.scene_file = scene.facts.scene_file;
  status.scene_toml = scene.facts.scene_toml;
  status.period_s = scene.facts.period_s;
  status.max_force_N = scene.facts.max_force_N;
  status.admitted = scene.admitted ? 1 : 0;
  return status;
}

/// Reads a flight recorder file: one session, ticks only.
ExportResult read_flight(const std::string& path, const RigFacts& facts, std::span<ExportSink* const> sinks) {
  const FlightReader recorder(path);
  if (recorder.ticks() == 0) throw BadInput(path + ": holds no tick");
  Walk walk(facts, sinks);
  ligature_msg::tick_batch_t batch{};
  batch.session = recorder.session();
  recorder.visit([&](const ligature_msg::tick_t& tick) {
    walk.take(status_of(recorder, tick.tick));
    batch.ticks.assign(1, tick);
    walk.take(batch);
  });
  ExportResult result = walk.finish();
  if (recorder.damaged_slots() > 0) result.damage = std::to_string(recorder.damaged_slots()) + " slots were damaged";
  return result;
}

}  // namespace

ExportResult read_recording(const std::string& path, const RigFacts& facts, std::span<ExportSink* const> sinks,
                            console::Progress* progress) {
  if (is_flight_file(path)) return read_flight(path, facts, sinks);
  Walk walk(facts, sinks);
  LogReader log(path, progress);
  while (const LogEvent* event = log.next()) walk.take(*event);
  if (!walk.has_ticks())
    throw BadInput(path + ": holds no readable tick in " + std::to_string(log.events()) +
                   " events; allowed: a log with messages on " + std::string(kTicksChannel));
  ExportResult result = walk.finish();
  result.damage = log.damage();
  return result;
}

}  // namespace ligature::host
