#include "host/exchange.hpp"

#include "host/wall_clock.hpp"
#include "protocol/lcm/fresh_id.hpp"

namespace ligature::host {

Exchange::Exchange(std::int8_t kind, const std::string& text, double value) {
  command_.utime = now_us();
  command_.id = lcm_tools::fresh_id();
  command_.kind = kind;
  command_.text = text;
  command_.value = value;
}

Exchange::Step Exchange::take(const ligature_msg::ack_t& ack) {
  if (ack.id != command_.id) return Step::kWait;
  const bool gives_challenge = ack.accepted == 0 && ack.challenge != 0;
  if (command_.challenge == 0 && gives_challenge) {
    command_.utime = now_us();
    command_.session = ack.session;
    command_.challenge = ack.challenge;
    return Step::kSay;
  }
  // If two firmwares share the network, the command goes to the one whose challenge came first. Answers of the other
  // one, which refuses a command not addressed to it, are ignored.
  const bool is_of_another = command_.challenge != 0 && ack.session != command_.session;
  return gives_challenge || is_of_another ? Step::kWait : Step::kAnswered;
}

bool Exchange::may_be_repeated() const { return command_.challenge == 0; }

std::string Exchange::silence() const {
  return command_.challenge == 0 ? "no rig answers; is ligature-firmware running with the same --lcm-url in the same "
                                   "network namespace?"
                                 : "no answer: whether it was done is not known, look at the rig's state";
}

}  // namespace ligature::host
