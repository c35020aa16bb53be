#include "firmware/platform/odrive_link.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "protocol/can/bit_time.hpp"
#include "protocol/can/units.hpp"

namespace ligature::platform {
namespace {

constexpr float kPeriod_ns = 1e6F;
constexpr unsigned kAllJoints = (1U << rt::kJoints) - 1U;

constexpr unsigned node_of(std::size_t joint) noexcept { return static_cast<unsigned>(joint) + 1U; }

}  // namespace

OdriveLink::OdriveLink(CanBus& bus, const device::Device& device) noexcept
    : bus_(bus),
      rad_per_rev_(2.0 * std::numbers::pi / device.gear),
      Nm_per_permille_(device.Nm_per_permille()),
      motor_Nm_per_permille_(device.Nm_per_permille() / device.gear),
      max_permille_(device.max_torque_permille),
      heartbeat_periods_(device.odrive.value_or(device::OdriveProfile{}).heartbeat_ms),
      buttons_id_(device.odrive.value_or(device::OdriveProfile{}).buttons_id) {}

void OdriveLink::request() noexcept {
  drain();
  bits_of_last_period_ = std::exchange(bits_, 0U);
  arrived_ = 0;
  if (age_ticks_ < std::numeric_limits<std::int32_t>::max()) ++age_ticks_;
  if (buttons_age_ <= kOldButtons) ++buttons_age_;
  for (Node& node : nodes_) node.silent = std::min(node.silent + 1, std::numeric_limits<int>::max() - 1);
  for (std::size_t j = 0; j < rt::kJoints; ++j) send(odrive::ask_estimates(node_of(j)));
}

void OdriveLink::drain() noexcept {
  can::Frame frame;
  for (int i = 0; i < kMaxFrames && bus_.receive(frame) == Receive::kFrame; ++i) take(frame);
  was_lost_ = was_lost_ || bus_.is_lost();
}

bool OdriveLink::send(const can::Frame& frame) noexcept {
  if (!bus_.send(frame)) {
    was_lost_ = was_lost_ || bus_.is_lost();
    return false;
  }
  bits_ += can::frame_bits(frame);
  return true;
}

void OdriveLink::take(const can::Frame& frame) noexcept {
  bits_ += can::frame_bits(frame);
  if (foreign_ == rt::Foreign::kNone) foreign_ = odrive::foreign_kind(frame);
  if (frame.id == buttons_id_) return take_buttons(frame);
  const auto address = odrive::address_of(frame.id);
  if (!address) return;
  Node& node = nodes_[address->joint];
  if (address->command == odrive::Command::kHeartbeat) {
    const auto beat = odrive::read_heartbeat(frame);
    if (!beat) return;
    node.heartbeat = *beat;
    node.silent = 0;
    node.beats = std::min(node.beats + 1, std::numeric_limits<int>::max() - 1);
  } else if (address->command == odrive::Command::kEstimates) {
    const auto position = odrive::read_position(frame);
    if (!position || !std::isfinite(*position)) return;  // no estimate
    pending_rev_[address->joint] = *position;
    arrived_ |= 1U << address->joint;
    take_set();
  }
}

/// The word of docs/wire.md, with its counter as a sign of life.
void OdriveLink::take_buttons(const can::Frame& frame) noexcept {
  if (frame.dlc != odrive::kButtonsBytes || can::is_remote(frame)) return;
  const auto word = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8U);
  const bool first = buttons_age_ > kOldButtons && !has_life_;
  const bool moved = can::profile::life_of(word) != can::profile::life_of(pending_buttons_);
  has_life_ = has_life_ || (moved && !first);
  still_frames_ = moved ? 0 : std::min(still_frames_ + 1, kStillFrames);
  pending_buttons_ = word;
  buttons_age_ = 0;
  take_set();
}

/// Joints are used only as a complete set of answers to one request, with buttons that are not older than some periods:
/// these come by a timer of their module.
void OdriveLink::take_set() noexcept {
  if (arrived_ != kAllJoints || !has_buttons()) return;
  rev_ = pending_rev_;
  buttons_ = pending_buttons_;
  valid_ = true;
  age_ticks_ = 0;
}

rt::HandReading OdriveLink::reading() const noexcept {
  rt::HandReading r;
  r.bus_lost = was_lost_ || bus_.is_lost();
  r.foreign = foreign_;
  r.valid = valid_;
  r.age_ticks = age_ticks_;
  r.bus_load = static_cast<float>(can::bits_to_ns(bits_of_last_period_)) / kPeriod_ns;
  r.enabled = valid_;
  r.buttons_stuck = has_life_ && still_frames_ >= kStillFrames;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const Node& node = nodes_[j];
    r.q_rad[j] = rev_[j] * rad_per_rev_;
    r.enabled = r.enabled && node.is_on();
    r.drive_fault = r.drive_fault || node.heartbeat.error != 0 || node.silent > kMissedBeats * heartbeat_periods_;
  }
  r.grip = (buttons_ & can::profile::kButtonGrip) != 0;
  r.dead_man = (buttons_ & can::profile::kButtonDeadMan) != 0;
  r.clutch = (buttons_ & can::profile::kButtonClutch) != 0;
  return r;
}

std::int16_t OdriveLink::permille_of(double torque_Nm) const noexcept {
  return static_cast<std::int16_t>(can::round_clipped(torque_Nm / Nm_per_permille_, max_permille_));
}

std::array<std::int16_t, rt::kJoints> OdriveLink::write(const rt::HandCommand& command) noexcept {
  std::array<std::int16_t, rt::kJoints> sent{};
  was_lost_ = false;
  if (command.request == rt::DriveRequest::kHold || command.request == rt::DriveRequest::kStop) {
    switch_off(command.request == rt::DriveRequest::kStop);
    return sent;
  }
  off_periods_ = 0;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const std::int16_t torque = permille_of(command.torque_Nm[j]);
    if (send(odrive::set_torque(node_of(j), static_cast<float>(torque * motor_Nm_per_permille_)))) sent[j] = torque;
  }
  if (command.request == rt::DriveRequest::kEnable) {
    // One drive a period, and each again only after its heartbeat can have told the result
    const auto joint = static_cast<std::size_t>(up_periods_);
    if (joint < rt::kJoints) bring_up(joint);
    up_periods_ = up_periods_ >= 2 * heartbeat_periods_ ? 0 : up_periods_ + 1;
  }
  return sent;
}

void OdriveLink::bring_up(std::size_t joint) noexcept {
  const Node& node = nodes_[joint];
  if (node.heartbeat.error != 0)
    send(odrive::clear_errors(node_of(joint)));
  else if (!node.is_on())
    send(odrive::set_axis_state(node_of(joint), odrive::kClosedLoop));
}

/// First zero torque, then the power stage off, until the heartbeats say so. No torque messages after the first period:
/// they would feed the watchdog of a drive that does not obey. After a stop an emergency stop is sent in every period,
/// which only a restart clears; at once if somebody else commands the drives.
void OdriveLink::switch_off(bool stops) noexcept {
  const bool first = off_periods_ == 0 && foreign_ == rt::Foreign::kNone;
  off_periods_ = std::min(off_periods_ + 1, std::numeric_limits<int>::max() - 1);
  up_periods_ = 0;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const bool said_off = nodes_[j].heartbeat.state == odrive::kIdle && nodes_[j].silent + 1 < off_periods_;
    if (first)
      send(odrive::set_torque(node_of(j), 0.0F));
    else if (stops)
      send(odrive::estop(node_of(j)));
    else if (!said_off)
      send(odrive::set_axis_state(node_of(j), odrive::kIdle));
  }
}

}  // namespace ligature::platform
