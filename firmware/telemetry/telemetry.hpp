#pragma once
// Drains what the real-time thread leaves and decides what is sent when. Time comes in as an argument.

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/rt/outlets.hpp"
#include "firmware/telemetry/command_gate.hpp"
#include "firmware/telemetry/event_finder.hpp"
#include "firmware/telemetry/flight_recorder.hpp"
#include "ligature_msg/ack_t.hpp"
#include "ligature_msg/command_t.hpp"
#include "ligature_msg/event_t.hpp"
#include "ligature_msg/offer_t.hpp"
#include "ligature_msg/status_t.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_batch_t.hpp"

namespace ligature::telemetry {

/// Where messages go. Implementations may lose them, but neither block for long nor throw.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void send(const ligature_msg::tick_batch_t& m) = 0;
  virtual void send(const ligature_msg::thread_t& m) = 0;
  virtual void send(const ligature_msg::status_t& m) = 0;
  virtual void send(const ligature_msg::event_t& m) = 0;
  virtual void send(const ligature_msg::offer_t& m) = 0;
};

/// One instant on two clocks. What is due when goes by the first alone; the second stamps messages and may be set back.
struct Moment {
  std::int64_t monotonic_us = 0;  ///< CLOCK_MONOTONIC
  std::int64_t utime = 0;         ///< CLOCK_REALTIME, microseconds
};

/// What a change of scene changes.
struct SceneFacts {
  std::string scene_file;
  std::string scene_toml;
  double max_force_N = 0.0;
  double radius_m = 0.0;
  bool admitted = true;         ///< its worst tick fits; false: run by --force, as its text says, too
  std::int64_t first_tick = 0;  ///< in force from it on
};

/// What does not change during a run, and the scene that it began with.
struct Session {
  std::int64_t id = 0;  ///< CLOCK_REALTIME at start, microseconds
  std::string firmware_version;
  SceneFacts scene;
  double period_s = 0.001;
  bool realtime = false;
  std::string recorder_file;  ///< empty: none
};

/// One thread uses it. Every record goes into exactly one batch, in order; a batch has 20 of them, the last one what is
/// left. Shapes at 60 Hz, status at 10 Hz, the offer at 1 Hz, events at once; among them what the flight recorder
/// notes. Commands that were played back are told once a second at most, however many come.
class Telemetry {
 public:
  static constexpr std::size_t kTicksPerBatch = 20;
  static constexpr std::int64_t kShapePeriod_us = 1'000'000 / 60;
  static constexpr std::int64_t kStatusPeriod_us = 100'000;
  static constexpr std::int64_t kOfferPeriod_us = 1'000'000;
  static constexpr std::int64_t kRefusalPeriod_us = 1'000'000;

  /// @param recorder whose notes are passed on; may be missing.
  Telemetry(Session session, const Names& names, rt::Outlets& outlets, Sink& sink, FlightRecorder* recorder = nullptr);

  /// Takes everything that is there.
  void step(Moment now);

  /// The last step: also what does not fill a batch, the last shape and a last status.
  void finish(Moment now);

  /// The scenes and parameters that may be asked for; told from now on.
  void set_offer(ligature_msg::offer_t offer);

  /// Another scene or parameter is in force since its first tick: told at once, with the words of the event.
  void scene_changed(const SceneFacts& facts, const std::string& text, Moment now);

  /// The state after the newest record: what a request is judged by before the loop judges it.
  [[nodiscard]] const rt::TickRecord& last() const noexcept { return last_; }

  /// The answer to a command that goes no further: it only asked for its challenge, or was played back, which is told.
  [[nodiscard]] std::optional<ligature_msg::ack_t> turn_away(const ligature_msg::command_t& command, Moment now);

  /// Who answers, and when.
  void stamp(ligature_msg::ack_t& ack, Moment now) const;

  /// Passes a request on, or says why not.
  [[nodiscard]] ligature_msg::ack_t handle(const ligature_msg::command_t& command, Moment now);

 private:
  void take(const rt::TickRecord& record, Moment now);
  void send_notes(Moment now);
  void send_batch(Moment now);
  void send_shape(Moment now);
  void send_status(Moment now);
  void send_offer(Moment now);
  void tell_refusal(const ligature_msg::command_t& command, const std::string& why, Moment now);
  [[nodiscard]] std::string objection(std::int8_t kind) const;

  Session session_;
  CommandGate gate_;
  Names names_;
  EventFinder events_;
  rt::Outlets& outlets_;
  Sink& sink_;
  FlightRecorder* recorder_;
  ligature_msg::tick_batch_t batch_{};
  ligature_msg::offer_t offer_{};
  rt::TickRecord last_{};
  std::int64_t misses_ = 0, lost_ = 0;
  std::int64_t shape_due_us_ = 0, status_due_us_ = 0, offer_due_us_ = 0;  // CLOCK_MONOTONIC
  std::int64_t refusal_due_us_ = 0, untold_refusals_ = 0;
};

}  // namespace ligature::telemetry
