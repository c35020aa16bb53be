#include "firmware/telemetry/command_gate.hpp"

#include <algorithm>
#include <utility>

#include "protocol/lcm/fresh_id.hpp"

namespace ligature::telemetry {
namespace {

using ligature_msg::command_t;

constexpr bool only_takes_force_away(std::int8_t kind) {
  return kind == command_t::KIND_STOP || kind == command_t::KIND_DISARM;
}

}  // namespace

CommandGate::CommandGate(std::int64_t session) : CommandGate(session, lcm_tools::fresh_id) {}

CommandGate::Judgement CommandGate::judge(const command_t& command, std::int64_t monotonic_us) {
  if (only_takes_force_away(command.kind)) return {true, 0, {}};
  const bool asks = command.challenge == 0 && (command.session == 0 || command.session == session_);
  if (!asks) {
    std::string why = objection(command, monotonic_us);
    return {why.empty(), 0, std::move(why)};
  }
  auto& open = open_[next_++ % kMostOpen];
  open = {0, command.id, monotonic_us + kLongest_us, command.kind};
  while (open.challenge == 0) open.challenge = draw_();
  return {false, open.challenge, {}};
}

/// Why the command must not be executed; empty if it may, and then its challenge is used up.
std::string CommandGate::objection(const command_t& command, std::int64_t monotonic_us) {
  if (command.session != session_)
    return "command of session " + std::to_string(command.session) + ", this is session " + std::to_string(session_) +
           ": played back from a recording, or meant for another rig";
  const auto found = std::ranges::find_if(open_, [&](const Open& open) {
    return open.challenge == command.challenge && open.id == command.id && open.kind == command.kind &&
           monotonic_us <= open.until_us;
  });
  if (found == open_.end())
    return "command of session " + std::to_string(command.session) +
           " replayed: its challenge was used before, is older than 2 s or was never given";
  *found = {};
  return {};
}

}  // namespace ligature::telemetry
