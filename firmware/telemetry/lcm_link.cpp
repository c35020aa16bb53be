#include "firmware/telemetry/lcm_link.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace ligature::telemetry {

LcmLink::LcmLink(const std::string& url, OnEvent on_event)
    : lcm_(url), open_(lcm_.good()), on_event_(std::move(on_event)) {}

bool LcmLink::listen(OnCommand on_command) {
  on_command_ = std::move(on_command);
  if (!open_) return false;
  listening_ = lcm_.subscribe("LIGATURE_COMMAND", &LcmLink::receive, this) != nullptr;
  return listening_;
}

void LcmLink::wait(std::int64_t at_most_ms) {
  if (!listening_ || lcm_.handleTimeout(static_cast<int>(at_most_ms)) < 0) {
    listening_ = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(at_most_ms));
  }
}

void LcmLink::receive(const lcm::ReceiveBuffer*, const std::string&, const ligature_msg::command_t* command) {
  publish("LIGATURE_ACK", on_command_(*command));
}

}  // namespace ligature::telemetry
