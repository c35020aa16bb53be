#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/gap_counter.hpp"

namespace ligature::host {

/// What was received of one session (one run of the firmware).
struct Session {
  std::int64_t id = 0;            // CLOCK_REALTIME at the session's start, us
  std::int64_t ring_dropped = 0;  // ticks that the firmware's ring buffer dropped, included in ticks.missing()
  GapCounter ticks;
  std::int8_t last_state = 0;  // state (STATE_ of tick_t) in the tick with the highest number
};

/// Counts received and missing ticks per session. Sessions are kept apart because a restarted firmware counts from zero
/// again, and because two firmwares that run at once by mistake would look like thousands of gaps.
class SessionTally {
 public:
  /// Limit on the sessions of one recording. No rig starts so many, so further sessions are forged or damaged.
  static constexpr std::size_t kMaxSessions = 1000;

  /// The session with that id, created when new. @return its index, or -1 beyond kMaxSessions.
  int find_or_add(std::int64_t id);
  /// Counts ticks of a session beyond kMaxSessions; nothing else is known of them.
  void leave_out(std::size_t ticks) { left_out_ += static_cast<std::int64_t>(ticks); }
  /// Counts a tick of the session at `index`. @return false for a duplicate.
  bool add(int index, std::int64_t tick, std::int8_t state = 0);
  Session& operator[](int index) { return sessions_[static_cast<std::size_t>(index)]; }

  [[nodiscard]] std::span<const Session> sessions() const { return sessions_; }
  [[nodiscard]] std::int64_t received() const;
  [[nodiscard]] std::int64_t missing() const;
  [[nodiscard]] std::int64_t duplicates() const;
  /// Ticks of sessions beyond kMaxSessions; not in received()
  [[nodiscard]] std::int64_t left_out() const { return left_out_; }
  /// The first session whose last tick is not in state OFF, null when there is none. Every run that ends normally ends
  /// in OFF. Otherwise the firmware or the recorder was killed, or the recorder was stopped first, and it is unknown
  /// how many ticks followed.
  [[nodiscard]] const Session* open_ended() const;
  /// True when two firmwares sent at the same time: a session continued after a later one had begun.
  [[nodiscard]] bool are_interleaved() const { return interleaved_; }
  [[nodiscard]] std::size_t restarts() const { return sessions_.empty() ? 0 : sessions_.size() - 1; }

 private:
  std::vector<Session> sessions_;  // the sessions, in order of their first message
  bool interleaved_ = false;
  std::int64_t left_out_ = 0;
};

}  // namespace ligature::host
