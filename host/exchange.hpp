#pragma once
// One command on its way to the firmware: asked for a challenge, said with it, answered.

#include <cstdint>
#include <string>

#include "host/messages.hpp"

namespace ligature::host {

/// The firmware does a command only with a challenge that it has just given out for it, so that a recording that is
/// played back moves nothing (protocol/lcm/command_t.lcm). `stop` and `disarm` need none.
class Exchange {
 public:
  Exchange(std::int8_t kind, const std::string& text, double value);

  /// What is to be published now.
  [[nodiscard]] const ligature_msg::command_t& message() const { return command_; }
  [[nodiscard]] std::int64_t id() const { return command_.id; }

  enum class Step : std::uint8_t {
    kWait,      ///< that was another's answer, or no news
    kSay,       ///< the challenge has come: publish message() once
    kAnswered,  ///< the answer proper
  };
  [[nodiscard]] Step take(const ligature_msg::ack_t& ack);

  /// Publishing message() again does no harm: it is a stop, or it only asks. Others are said once, because doing them
  /// twice is not the same.
  [[nodiscard]] bool may_be_repeated() const;

  /// What to tell a person when no answer has come in time.
  [[nodiscard]] std::string silence() const;

 private:
  ligature_msg::command_t command_{};
};

}  // namespace ligature::host
