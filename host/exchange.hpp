#pragma once
// The exchange of messages that carries one command to the firmware: request a challenge, send the command with it, get
// the answer.

#include <cstdint>
#include <string>

#include "host/messages.hpp"

namespace ligature::host {

/// The firmware carries out a command only with a challenge that it has just issued for it, so that replaying a
/// recording cannot move anything (protocol/lcm/command_t.lcm). `stop` and `disarm` need no challenge.
class Exchange {
 public:
  Exchange(std::int8_t kind, const std::string& text, double value);

  /// The message to publish next.
  [[nodiscard]] const ligature_msg::command_t& message() const { return command_; }
  [[nodiscard]] std::int64_t id() const { return command_.id; }

  enum class Step : std::uint8_t {
    kWait,      ///< the message answers another program's command, or changes nothing
    kSay,       ///< the challenge has arrived: publish message() once
    kAnswered,  ///< the final answer to the command has arrived
  };
  [[nodiscard]] Step take(const ligature_msg::ack_t& ack);

  /// Whether message() may be published again when no answer comes: true for a stop and for a request for a challenge.
  /// Other commands are sent once, because executing them twice can have another effect than executing them once.
  [[nodiscard]] bool may_be_repeated() const;

  /// The error text for a missing answer.
  [[nodiscard]] std::string silence() const;

 private:
  ligature_msg::command_t command_{};
};

}  // namespace ligature::host
