#pragma once
// Distinguishes commands sent now, to this run of the firmware, from replays of a recording.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "ligature_msg/command_t.hpp"

namespace ligature::telemetry {

/// Every command except `stop` and `disarm` is sent twice: first without a challenge, to request one, then with the
/// challenge that the answer carries. A challenge is a random number; it is valid once, for the same command id and
/// kind, and for two seconds of the monotonic clock. A recording contains only used challenges, so replaying it has no
/// effect. `stop` and `disarm` only remove force, so they are always executed.
/// This detects replays; it does not authenticate senders.
class CommandGate {
 public:
  static constexpr std::int64_t kLongest_us = 2'000'000;
  static constexpr std::size_t kMostOpen = 256;  ///< open challenges; a further one replaces the oldest

  /// Source of random numbers; by default the system's.
  using Draw = std::function<std::int64_t()>;
  explicit CommandGate(std::int64_t session);
  CommandGate(std::int64_t session, Draw draw) : session_(session), draw_(std::move(draw)) {}

  struct Judgement {
    bool may_be_done = false;
    std::int64_t challenge = 0;  ///< not 0: the command only requested this challenge
    std::string why;             ///< not empty: refused as a replay, or as meant for another run
  };
  [[nodiscard]] Judgement judge(const ligature_msg::command_t& command, std::int64_t monotonic_us);

 private:
  struct Open {
    std::int64_t challenge = 0, id = 0, until_us = 0;
    std::int8_t kind = 0;
  };
  [[nodiscard]] std::string objection(const ligature_msg::command_t& command, std::int64_t monotonic_us);

  std::int64_t session_;
  Draw draw_;
  std::array<Open, kMostOpen> open_{};
  std::size_t next_ = 0;
};

}  // namespace ligature::telemetry
