#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/gap_counter.hpp"

namespace ligature::host {

/// What came of one run of the firmware.
struct Session {
  std::int64_t id = 0;            // CLOCK_REALTIME at its start, microseconds
  std::int64_t ring_dropped = 0;  // ticks the firmware itself could not keep: part of those missing
  GapCounter ticks;
  std::int8_t last_state = 0;  // of the tick with the highest number: STATE_ of tick_t
};

/// Which ticks came and which did not, kept apart by session: a restarted firmware counts from zero again,
/// and two that run at once by mistake do not look like thousands of gaps.
class SessionTally {
 public:
  /// More runs in one recording than a rig could start: such a message is forged or broken.
  static constexpr std::size_t kMaxSessions = 1000;

  /// The session of that id, made when it is new. @return its index, or -1 when there are too many.
  int find_or_add(std::int64_t id);
  /// Ticks of a session that has no place: nothing is known of them but that they came.
  void leave_out(std::size_t ticks) { left_out_ += static_cast<std::int64_t>(ticks); }
  /// Counts a tick of the session at `index`. @return false when it was there already.
  bool add(int index, std::int64_t tick, std::int8_t state = 0);
  Session& operator[](int index) { return sessions_[static_cast<std::size_t>(index)]; }

  [[nodiscard]] std::span<const Session> sessions() const { return sessions_; }
  [[nodiscard]] std::int64_t received() const;
  [[nodiscard]] std::int64_t missing() const;
  [[nodiscard]] std::int64_t duplicates() const;
  [[nodiscard]] std::int64_t left_out() const {
    return left_out_;
  }  ///< of sessions beyond kMaxSessions; not in received()
  /// The first session that does not end with its drives switched off, as every run does that is ended by order; null
  /// when there is none. Firmware or recorder were ended by force, or the recorder before the run: what came after its
  /// last tick is not in the recording, and nobody knows how much that is.
  [[nodiscard]] const Session* open_ended() const;
  /// Two firmwares sent at the same time: a session went on after a later one had begun.
  [[nodiscard]] bool are_interleaved() const { return interleaved_; }
  [[nodiscard]] std::size_t restarts() const { return sessions_.empty() ? 0 : sessions_.size() - 1; }

 private:
  std::vector<Session> sessions_;  // in order of their first message
  bool interleaved_ = false;
  std::int64_t left_out_ = 0;
};

}  // namespace ligature::host
