#include "sim_device/odrive_node.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace ligature::sim {
namespace {

std::uint32_t word(const can::Frame& f, unsigned at) {
  std::uint32_t w = 0;
  for (unsigned i = 4; i-- > 0;) w = w << 8U | f.data[at + i];
  return w;
}

}  // namespace

OdriveNode::OdriveNode(std::uint32_t node, const OdriveSettings& settings, Time now)
    : node_(node), settings_(settings) {
  boot(now);
}

void OdriveNode::boot(Time now) {
  powered_.disarm();
  state_ = 1;
  error_ = settings_.has_error ? 0x10U : 0U;
  control_mode_ = settings_.control_mode;
  input_mode_ = settings_.input_mode;
  current_limit_A_ = settings_.current_limit_A;
  input_torque_Nm_ = 0.0F;
  watchdog_.disarm();
  beat_.arm(now + settings_.heartbeat * (1 + node_) / 4);  // each with a phase of its own
  if (settings_.tells_position > Time(0)) position_.arm(now + settings_.tells_position);
  if (settings_.starts_in_closed_loop) request_state(8, now);
}

void OdriveNode::power_cycle(Time now, Time boot) {
  disarm(0);
  out.clear();
  beat_.disarm();
  position_.disarm();
  powered_.arm(now + boot);
}

void OdriveNode::disarm(std::uint32_t error) noexcept {
  error_ |= error;
  state_ = 1;
  input_torque_Nm_ = 0.0F;
  watchdog_.disarm();
}

float OdriveNode::torque_Nm() const noexcept {
  if (!is_on()) return 0.0F;
  const bool follows = input_mode_ == 1, holds_position = control_mode_ == 3;
  float rev_per_s = holds_position && !follows ? 0.0F : input_rev_per_s_;  // with a trajectory it makes its own
  if (holds_position) rev_per_s += kPosition_per_s * (input_rev_ - position_rev);
  return input_torque_Nm_ + (control_mode_ == 1 && follows ? 0.0F : kVelocity_Nm_s_per_rev * rev_per_s);
}

void OdriveNode::advance(Time now) {
  if (powered_.is_over(now)) boot(now);
  if (watchdog_.is_over(now)) {
    ++watchdog_trips;
    disarm(0x0100'0000);
  }
  if (position_.is_over(now)) {
    position_.arm(position_.at() + settings_.tells_position);
    answer(0x09);
  }
  if (!beat_.is_over(now)) return;
  beat_.arm(beat_.at() + settings_.heartbeat);
  send(0x01, error_, state_);
}

Time OdriveNode::next_deadline() const noexcept {
  return std::min({powered_.at(), watchdog_.at(), position_.at(), beat_.at()});
}

void OdriveNode::take(const can::Frame& frame, Time now) {
  advance(now);
  const bool is_off = powered_.at() != kNever;
  if (is_off || (frame.id & 0x7FFU) >> 5U != node_) return;
  const std::uint32_t number = frame.id & 0x1FU;
  if (settings_.has_old_watchdog) feed(now);
  if (can::is_remote(frame)) return answer(number);
  if (obeys) command(number, frame, now);
}

void OdriveNode::answer(std::uint32_t number) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  if (number == 0x00) send(number, 2, static_cast<std::uint32_t>(settings_.software_minor) << 8U);
  if (number == 0x03) send(number, error_, error_);
  if (number == 0x09) send(number, bits(position_rev), 0);
  if (number == 0x1C) {
    adds_ = !adds_;
    send(number, bits(torque_Nm() + (adds_ ? settings_.adds_Nm : 0.0F)), bits(torque_Nm()));
  }
}

void OdriveNode::command(std::uint32_t number, const can::Frame& frame, Time now) {
  switch (number) {
    case 0x02:
      return disarm(0x0200'0000);
    case 0x07:
      return request_state(word(frame, 0), now);
    case 0x0B:
      if (settings_.takes_mode) {
        control_mode_ = word(frame, 0);
        input_mode_ = word(frame, 4);
      }
      return;
    case 0x0C:
    case 0x0D:
      (number == 0x0C ? input_rev_ : input_rev_per_s_) = std::bit_cast<float>(word(frame, 0));
      return;
    case 0x0E:
      if (frame.dlc != 8 && !settings_.takes_short_torques) return;
      input_torque_Nm_ = is_on() ? std::bit_cast<float>(word(frame, 0)) : 0.0F;
      return feed(now);
    case 0x0F:
      current_limit_A_ = std::bit_cast<float>(word(frame, 4));
      return;
    case 0x18:
      if (!settings_.has_error) error_ = 0;
      return;
    default:
      return;
  }
}

void OdriveNode::request_state(std::uint32_t state, Time now) {
  if (state == 1 && settings_.obeys_idle) disarm(0);
  if (state != 8 || is_on() || error_ != 0) return;
  state_ = 8;
  input_rev_ = position_rev;
  input_rev_per_s_ = 0.0F;
  feed(now);
}

void OdriveNode::feed(Time now) noexcept {
  if ((is_on() || settings_.has_old_watchdog) && settings_.watchdog > Time(0)) watchdog_.arm(now + settings_.watchdog);
}

void OdriveNode::send(std::uint32_t number, std::uint32_t low, std::uint32_t high) {
  can::Frame f{node_ << 5U | number, 8, {}};
  for (unsigned i = 0; i < 4; ++i) {
    f.data[i] = static_cast<std::uint8_t>(low >> (8U * i));
    f.data[4 + i] = static_cast<std::uint8_t>(high >> (8U * i));
  }
  out.push_back(f);
}

}  // namespace ligature::sim
