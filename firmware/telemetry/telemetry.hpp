#pragma once
// Reads the records of the real-time thread and decides which messages are sent when. Time is passed as an argument.

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

/// Receiver of messages. Implementations may drop messages, but must not block for long or throw.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void send(const ligature_msg::tick_batch_t& m) = 0;
  virtual void send(const ligature_msg::thread_t& m) = 0;
  virtual void send(const ligature_msg::status_t& m) = 0;
  virtual void send(const ligature_msg::event_t& m) = 0;
  virtual void send(const ligature_msg::offer_t& m) = 0;
};

/// The present time on two clocks. Schedules use only the first; the second stamps messages and may be set back.
struct Moment {
  std::int64_t monotonic_us = 0;  ///< CLOCK_MONOTONIC
  std::int64_t utime = 0;         ///< CLOCK_REALTIME, microseconds
};

/// Properties of the scene in force.
struct SceneFacts {
  std::string scene_file;
  std::string scene_toml;
  double max_force_N = 0.0;
  double radius_m = 0.0;
  bool admitted = true;         ///< whether admission accepted it; false: runs by --force (also noted in scene_toml)
  std::int64_t first_tick = 0;  ///< first tick with this scene
};

/// Constant properties of a run, and the scene at its start.
struct Session {
  std::int64_t id = 0;  ///< CLOCK_REALTIME at start, microseconds
  std::string firmware_version;
  SceneFacts scene;
  double period_s = 0.001;
  bool realtime = false;
  std::string recorder_file;  ///< empty: none
};

/// Not thread-safe. Every record goes into exactly one batch, in order; a batch has 20 records, the last batch the
/// remainder. Shapes are sent at 60 Hz, status at 10 Hz, the offer (what commands may request) at 1 Hz, events and
/// notes of the flight recorder at once. Refused replays of commands are reported once per second at most.
class Telemetry {
 public:
  static constexpr std::size_t kTicksPerBatch = 20;
  static constexpr std::int64_t kShapePeriod_us = 1'000'000 / 60;
  static constexpr std::int64_t kStatusPeriod_us = 100'000;
  static constexpr std::int64_t kOfferPeriod_us = 1'000'000;
  static constexpr std::int64_t kRefusalPeriod_us = 1'000'000;

  /// @param recorder its notes are forwarded; may be null.
  Telemetry(Session session, const Names& names, rt::Outlets& outlets, Sink& sink, FlightRecorder* recorder = nullptr);

  /// Processes all available records and sends what is due.
  void step(Moment now);

  /// Last step: also sends an incomplete batch, the last shape and a last status.
  void finish(Moment now);

  /// Sets the list of scenes and parameters that commands may request; it is sent regularly from now on.
  void set_offer(ligature_msg::offer_t offer);

  /// Reports that a new scene or parameter is in force since its first tick; sends an event with `text` at once.
  void scene_changed(const SceneFacts& facts, const std::string& text, Moment now);

  /// The newest record. Commands are first checked against it; the loop checks them again.
  [[nodiscard]] const rt::TickRecord& last() const noexcept { return last_; }

  /// Refuses a command that only asks for a challenge, or that is replayed (this is also reported).
  /// @return the answer to the refused command; nothing if the command may be executed.
  [[nodiscard]] std::optional<ligature_msg::ack_t> turn_away(const ligature_msg::command_t& command, Moment now);

  /// Fills in the answer's time and session.
  void stamp(ligature_msg::ack_t& ack, Moment now) const;

  /// Passes a command to the loop, or refuses it.
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
