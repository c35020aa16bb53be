#include "firmware/platform/hand_link.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "firmware/platform/foreign_frame.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/startup.hpp"
#include "protocol/can/units.hpp"

namespace ligature::platform {
namespace {

constexpr unsigned kAllJoints = (1U << rt::kJoints) - 1U;
constexpr unsigned kInputsPart = 1U << rt::kJoints;

/// Index of the joint with this node id; kJoints if there is none.
constexpr std::size_t joint_of(can::NodeId node) noexcept {
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    if (can::profile::kJointNodes[j] == node) return j;
  }
  return rt::kJoints;
}

}  // namespace

HandLink::HandLink(CanBus& bus, const device::Device& device, int heartbeat_periods, std::size_t hand) noexcept
    : bus_(bus),
      rad_per_count_(device.rad_per_count()),
      Nm_per_permille_(device.Nm_per_permille()),
      max_permille_(device.max_torque_permille),
      tolerance_permille_(device.torque_tolerance_permille),
      buttons_(device.cia402.buttons),
      buttons_joint_(joint_of(can::NodeId{static_cast<std::uint8_t>(buttons_.node)})),
      inputs_id_(buttons_.are_inputs() ? can::pdo_place(false, 2, can::profile::kJointNodes[buttons_joint_]).id : 0),
      complete_(kAllJoints | (buttons_.are_inputs() ? kInputsPart : 0U)),
      heartbeat_periods_(heartbeat_periods),
      periods_to_heartbeat_(hand == 0 ? 0 : heartbeat_periods / 2) {}

can::cia402::State HandLink::Node::state() const noexcept {
  return can::cia402::state_of(latest.statusword).value_or(can::cia402::State::kNotReadyToSwitchOn);
}

void HandLink::send_sync() noexcept {
  drain();
  bus_.begin_period();
  arrived_ = 0;
  if (age_ticks_ < std::numeric_limits<std::int32_t>::max()) ++age_ticks_;
  bus_.send(can::sync_frame());
  if (stops_) bus_.send(can::encode_nmt(can::NmtCommand::kStop));
}

/// Whether to send a heartbeat, which tells the drives that they may go on. No heartbeat is sent while the drives must
/// have no torque but may still have some: then the drives' own watchdog removes the torque. After a stop the torque is
/// unknown, because a stopped drive sends no samples. After a foreign controller was heard there is no heartbeat
/// either: on a flooded bus NMT stop would wait behind it.
bool HandLink::may_beat(rt::DriveRequest request) noexcept {
  if (request == rt::DriveRequest::kStop || foreign_ != rt::Foreign::kNone) return false;
  const bool sure = request != rt::DriveRequest::kHold || are_off();
  periods_on_ = sure ? 0 : std::min(periods_on_ + 1, kObey);
  return periods_on_ < kObey;
}

/// Whether all drives have said in this period that they are off, and report no torque.
bool HandLink::are_off() const noexcept {
  return age_ticks_ == 0 && std::ranges::all_of(nodes_, [this](const Node& node) {
           return is_off(node.state()) && std::abs(node.latest.torque_permille) <= tolerance_permille_;
         });
}

/// A heartbeat has the lowest priority on the bus: while others send, it waits and so does everything queued behind it.
/// So it is sent after the drives have answered, when the bus is free.
void HandLink::beat() noexcept {
  if (--periods_to_heartbeat_ >= 0) return;
  bus_.send(can::encode(can::Heartbeat{can::kMasterNode, can::NmtState::kOperational}));
  periods_to_heartbeat_ = heartbeat_periods_ - 1;
}

void HandLink::drain() noexcept {
  bus_.drain([this](const can::Frame& frame) noexcept { take(frame); });
}

void HandLink::take(const can::Frame& frame) noexcept {
  if (foreign_ == rt::Foreign::kNone) foreign_ = foreign_kind(frame);
  if (inputs_id_ != 0 && frame.id == inputs_id_ && frame.dlc == buttons_.bits / 8) {
    pending_inputs_ = static_cast<std::uint32_t>(can::data_word(frame));
    return take_part(kInputsPart);
  }
  const auto address = can::address_of(frame.id);
  if (!address) return;
  const std::size_t joint = joint_of(address->node);
  if (joint == rt::kJoints) return;
  switch (address->service) {
    case can::Service::kTpdo1:
      if (const auto tpdo = can::decode_tpdo1(address->node, frame, has_word(joint))) take_tpdo(joint, *tpdo);
      break;
    case can::Service::kEmcy:
      if (const auto emergency = can::decode_emergency(frame)) nodes_[joint].emergency = emergency->code;
      break;
    case can::Service::kHeartbeat:
      if (const auto beat = can::decode_heartbeat(frame)) {
        nodes_[joint].operational = beat->state == can::NmtState::kOperational;
      }
      break;
    default:
      break;
  }
}

/// Whether this joint's TPDO has our own buttons' word instead of the torque.
bool HandLink::has_word(std::size_t joint) const noexcept { return !buttons_.are_inputs() && joint == buttons_joint_; }

void HandLink::note_life(std::uint16_t buttons) noexcept {
  const bool moved = can::profile::life_of(buttons) != can::profile::life_of(nodes_[buttons_joint_].latest.buttons);
  has_life_ = has_life_ || moved;
  still_sets_ = moved ? 0 : still_sets_ + (still_sets_ < kStillSets);
}

void HandLink::take_tpdo(std::size_t joint, const can::Tpdo1& tpdo) noexcept {
  pending_[joint] = tpdo;
  take_part(1U << joint);
}

/// Joints are used only as a complete set sampled at one SYNC: a mixture of ages would be a pose that never existed.
void HandLink::take_part(unsigned part) noexcept {
  arrived_ |= part;
  if (arrived_ != complete_) return;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    if (has_word(j) && valid_) note_life(pending_[j].buttons);
    nodes_[j].latest = pending_[j];
  }
  inputs_ = pending_inputs_;
  arrived_ = 0;
  valid_ = true;
  age_ticks_ = 0;
}

rt::HandReading HandLink::reading() const noexcept {
  using can::cia402::State;
  rt::HandReading r;
  bus_.tell(r);
  r.foreign = foreign_;
  r.valid = valid_;
  r.age_ticks = age_ticks_;
  r.enabled = valid_;
  r.buttons_stuck = has_life_ && still_sets_ >= kStillSets;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const Node& node = nodes_[j];
    const State state = node.state();
    r.q_rad[j] = node.latest.position_counts * rad_per_count_;
    const bool is_on = state == State::kOperationEnabled, is_missing = age_ticks_ > 0 && (arrived_ & 1U << j) == 0;
    const bool has_failed = node.emergency != can::emcy::kNoError || !node.operational ||
                            (valid_ && (state == State::kFault || state == State::kFaultReactionActive));
    r.tell_drive(j, {is_on, is_missing, has_failed, node.emergency});
    // Only drives with Ligature's own profile (docs/wire.md) use this statusword bit for a wrong torque. Other drives
    // report the torque of every joint instead.
    r.torque_astray[j] = !buttons_.are_inputs() && (node.latest.statusword & can::cia402::kTorqueAstrayBit) != 0;
    r.torque_limited[j] = (node.latest.statusword & can::cia402::kInternalLimitBit) != 0;
    if (has_word(j))
      r.torque_held[j] = can::profile::held_of(node.latest.buttons);
    else if (valid_)
      r.torque_Nm[j] = node.latest.torque_permille * Nm_per_permille_;
  }
  const bool inputs_are_missing = age_ticks_ > 0 && (complete_ & ~arrived_ & kInputsPart) != 0;
  r.tell_drive(rt::HandReading::kButtonModule, {.is_silent = inputs_are_missing});
  tell_buttons(r);
  return r;
}

void HandLink::tell_buttons(rt::HandReading& r) const noexcept {
  const std::uint32_t word = buttons_.are_inputs() ? inputs_ : nodes_[buttons_joint_].latest.buttons;
  const auto pressed = [word](int bit) { return bit >= 0 && ((word >> static_cast<unsigned>(bit)) & 1U) != 0; };
  r.grip = pressed(buttons_.grip_bit);
  r.dead_man = pressed(buttons_.dead_man_bit);
  r.clutch = pressed(buttons_.clutch_bit);
}

std::int16_t HandLink::permille_of(double torque_Nm) const noexcept {
  return static_cast<std::int16_t>(can::round_clipped(torque_Nm / Nm_per_permille_, max_permille_));
}

std::array<std::int16_t, rt::kJoints> HandLink::write(const rt::HandCommand& command) noexcept {
  std::array<std::int16_t, rt::kJoints> sent{};
  bus_.forget_loss();
  // A stop begins with controlword 0 and torque 0, which act at the next SYNC. NMT stop follows after that SYNC,
  // because a drive may keep its last torque while it is stopped. After a foreign controller was heard, NMT stop is
  // sent at once: until a drive is stopped, the foreign controller could command a torque.
  stops_ = command.request == rt::DriveRequest::kStop;
  if (stops_ && foreign_ != rt::Foreign::kNone) bus_.send(can::encode_nmt(can::NmtCommand::kStop));
  if (may_beat(command.request)) beat();
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    Node& node = nodes_[j];
    const auto state = node.state();
    if (command.request == rt::DriveRequest::kEnable && state == can::cia402::State::kOperationEnabled) {
      node.emergency = can::emcy::kNoError;  // the drive is enabled again: its earlier error no longer counts
    }
    node.controlword = controlword(command.request, state, node.controlword);
    const std::int16_t torque = stops_ ? std::int16_t{0} : permille_of(command.torque_Nm[j]);
    if (bus_.send(can::encode(can::profile::kJointNodes[j], can::Rpdo1{node.controlword, torque}))) sent[j] = torque;
  }
  return sent;
}

}  // namespace ligature::platform
