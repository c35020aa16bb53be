#pragma once
// Whether a command is said now, to this run of the firmware, or played back from a recording.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "ligature_msg/command_t.hpp"

namespace ligature::telemetry {

/// Every command but `stop` and `disarm` is sent twice: first without a challenge, which asks for one, then with the
/// challenge that the answer carries. A challenge is a random number, good for one command, for that sender's id and
/// kind, and for two seconds of the monotonic clock. A recording holds challenges that were used, so playing it back
/// does nothing. `stop` and `disarm` only take force away: they are done whoever said them and whenever.
/// This tells a recording from a living sender; it does not tell one living sender from another.
class CommandGate {
 public:
  static constexpr std::int64_t kLongest_us = 2'000'000;
  static constexpr std::size_t kMostOpen = 256;  ///< the oldest goes when more are asked for

  /// Random numbers; from the system's where none is given.
  using Draw = std::function<std::int64_t()>;
  explicit CommandGate(std::int64_t session);
  CommandGate(std::int64_t session, Draw draw) : session_(session), draw_(std::move(draw)) {}

  struct Judgement {
    bool may_be_done = false;
    std::int64_t challenge = 0;  ///< not 0: the command only asked for it
    std::string why;             ///< not empty: it was played back, or meant for another run
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
