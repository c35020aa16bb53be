#include "host/send.hpp"

#include <chrono>
#include <cstdio>
#include <vector>

#include "host/errors.hpp"
#include "host/lcm_link.hpp"
#include "host/stop_signal.hpp"

namespace ligature::host {
namespace {

using Clock = std::chrono::steady_clock;
using Command = ligature_msg::command_t;
constexpr auto kAnswerWithin = std::chrono::seconds(1);
constexpr auto kRepeatEvery = std::chrono::milliseconds(100);

std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void publish(LcmLink& link, const Command& command) {
  std::vector<char> bytes(static_cast<std::size_t>(command.getEncodedSize()));
  command.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  link.publish(kCommandChannel, bytes.data(), static_cast<unsigned>(bytes.size()));
}

}  // namespace

std::optional<std::int8_t> command_kind(std::string_view word) {
  if (word == "arm") return Command::KIND_ARM;
  if (word == "disarm") return Command::KIND_DISARM;
  if (word == "stop") return Command::KIND_STOP;
  if (word == "reset-fault") return Command::KIND_RESET_FAULT;
  if (word == "reset-thread") return Command::KIND_RESET_THREAD;
  return std::nullopt;
}

void send(std::string_view word, const std::string& lcm_url) {
  const auto kind = command_kind(word);
  if (!kind)
    throw BadInput("send: found '" + std::string(word) + "', allowed arm, disarm, stop, reset-fault, reset-thread");
  Command command{};
  command.utime = command.id = now_us();
  command.kind = *kind;

  std::optional<ligature_msg::ack_t> answer;
  LcmLink link(lcm_url, std::string(kAckChannel), [&](const Message& message) {
    if (auto ack = decode<ligature_msg::ack_t>(message.data); ack && ack->id == command.id) answer = std::move(ack);
  });
  const auto start = Clock::now();
  publish(link, command);
  for (auto sent = start; !answer && Clock::now() - start < kAnswerWithin && !stop_requested();) {
    link.receive(50);
    if (!answer && *kind == Command::KIND_STOP && Clock::now() - sent >= kRepeatEvery) {
      publish(link, command);
      sent = Clock::now();
    }
  }
  const std::string what(word);
  if (!answer)
    throw RunFailed(what +
                    ": no answer within 1 s; is ligature-firmware running with the same --lcm-url in the same "
                    "network namespace?");
  if (!answer->accepted) throw RunFailed(what + " refused: " + answer->reason);
  std::printf("%s accepted%s%s\n", what.c_str(), answer->reason.empty() ? "" : ": ", answer->reason.c_str());
}

}  // namespace ligature::host
