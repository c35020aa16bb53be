#include "host/send.hpp"

#include <chrono>
#include <cstdio>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/lcm_link.hpp"
#include "host/wall_clock.hpp"

namespace ligature::host {
namespace {

using Clock = std::chrono::steady_clock;
using Command = ligature_msg::command_t;
constexpr auto kRepeatEvery = std::chrono::milliseconds(100);

}  // namespace

std::optional<std::int8_t> command_kind(std::string_view word) {
  if (word == "arm") return Command::KIND_ARM;
  if (word == "disarm") return Command::KIND_DISARM;
  if (word == "stop") return Command::KIND_STOP;
  if (word == "reset-fault") return Command::KIND_RESET_FAULT;
  if (word == "reset-thread") return Command::KIND_RESET_THREAD;
  if (word == "load-scene") return Command::KIND_LOAD_SCENE;
  if (word == "set") return Command::KIND_SET_PARAMETER;
  if (word == "clutch left") return Command::KIND_CLUTCH_LEFT;
  if (word == "unclutch left") return Command::KIND_UNCLUTCH_LEFT;
  if (word == "clutch right") return Command::KIND_CLUTCH_RIGHT;
  if (word == "unclutch right") return Command::KIND_UNCLUTCH_RIGHT;
  if (word == "park") return Command::KIND_PARK;
  if (word == "calibrate") return Command::KIND_CALIBRATE;
  return std::nullopt;
}

std::chrono::seconds answer_time(std::int8_t kind) {
  const bool is_measured_first = kind == Command::KIND_LOAD_SCENE || kind == Command::KIND_SET_PARAMETER;
  return std::chrono::seconds(is_measured_first ? 10 : 1);
}

void send(std::string_view word, const std::string& text, double value, const std::string& lcm_url) {
  const auto kind = command_kind(word);
  if (!kind)
    throw BadInput(
        "send: found '" + std::string(word) +
        "', allowed arm, disarm, stop, reset-fault, reset-thread, clutch, unclutch, park, calibrate, load-scene, set");
  Command command{};
  command.utime = command.id = now_us();
  command.kind = *kind;
  command.text = text;
  command.value = value;
  const auto patience = answer_time(*kind);

  std::optional<ligature_msg::ack_t> answer;
  LcmLink link(lcm_url, std::string(kAckChannel), [&](const Message& message) {
    if (auto ack = decode<ligature_msg::ack_t>(message.data); ack && ack->id == command.id) answer = std::move(ack);
  });
  const auto start = Clock::now();
  link.publish(kCommandChannel, command);
  for (auto sent = start; !answer && Clock::now() - start < patience && !console::stop_requested();) {
    link.receive(50);
    if (!answer && *kind == Command::KIND_STOP && Clock::now() - sent >= kRepeatEvery) {
      link.publish(kCommandChannel, command);
      sent = Clock::now();
    }
  }
  const std::string what(word);
  if (!answer)
    throw RunFailed(what + ": no answer within " + std::to_string(patience.count()) +
                    " s; is ligature-firmware running with the same --lcm-url in the same "
                    "network namespace?");
  if (!answer->accepted) throw RunFailed(what + " refused: " + answer->reason);
  std::printf("%s accepted%s%s\n", what.c_str(), answer->reason.empty() ? "" : ": ", answer->reason.c_str());
}

}  // namespace ligature::host
