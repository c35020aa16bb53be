#include "host/send.hpp"

#include <chrono>
#include <cstdio>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/exchange.hpp"
#include "host/lcm_link.hpp"
#include "protocol/lcm/command_words.hpp"

namespace ligature::host {
namespace {

using Clock = std::chrono::steady_clock;
using Command = ligature_msg::command_t;
constexpr auto kRepeatEvery = std::chrono::milliseconds(100);

}  // namespace

std::chrono::seconds answer_time(std::int8_t kind) {
  const bool is_measured_first = kind == Command::KIND_LOAD_SCENE || kind == Command::KIND_SET_PARAMETER;
  return std::chrono::seconds(is_measured_first ? 10 : 1);
}

void send(std::string_view word, const std::string& text, double value, const std::string& lcm_url) {
  const auto kind = lcm_tools::command_kind(word);
  if (!kind)
    throw BadInput(
        "send: found '" + std::string(word) +
        "', allowed arm, disarm, stop, reset-fault, reset-thread, clutch, unclutch, park, calibrate, load-scene, set");
  Exchange exchange(*kind, text, value);
  const auto patience = answer_time(*kind);

  std::optional<ligature_msg::ack_t> answer;
  bool say = true;
  LcmLink link(lcm_url, std::string(kAckChannel), [&](const Message& message) {
    auto ack = decode<ligature_msg::ack_t>(message.data);
    const auto step = ack ? exchange.take(*ack) : Exchange::Step::kWait;
    say = say || step == Exchange::Step::kSay;
    if (step == Exchange::Step::kAnswered) answer = std::move(ack);
  });
  const auto start = Clock::now();
  for (auto said = start; !answer && Clock::now() - start < patience && !console::stop_requested();) {
    if (say || (exchange.may_be_repeated() && Clock::now() - said >= kRepeatEvery)) {
      link.publish(kCommandChannel, exchange.message());
      said = Clock::now();
      say = false;
    }
    link.receive(50);
  }
  const std::string what(word);
  if (!answer) throw RunFailed(what + ": within " + std::to_string(patience.count()) + " s " + exchange.silence());
  if (!answer->accepted) throw RunFailed(what + " refused: " + answer->reason);
  std::printf("%s accepted%s%s\n", what.c_str(), answer->reason.empty() ? "" : ": ", answer->reason.c_str());
}

}  // namespace ligature::host
