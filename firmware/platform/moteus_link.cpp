#include "firmware/platform/moteus_link.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/can/units.hpp"

namespace ligature::platform {
namespace {

constexpr double kRad_per_rev = 2.0 * std::numbers::pi;
using moteus::Extra;
using moteus::Mode;

constexpr unsigned node_of(std::size_t joint) noexcept { return static_cast<unsigned>(joint) + 1U; }

}  // namespace

MoteusLink::MoteusLink(CanBus& bus, const device::Device& device, int watchdog_ms) noexcept
    : bus_(bus),
      Nm_per_permille_(device.Nm_per_permille()),
      max_permille_(device.max_torque_permille),
      limits_{static_cast<float>(device.max_torque_Nm()), static_cast<float>(watchdog_ms) / 1000.0F} {}

void MoteusLink::request() noexcept {
  drain();
  bus_.begin_period();
  if (!answers_.begin_period(true)) return;
  asked_ = static_cast<Extra>((static_cast<std::size_t>(asked_) + 1) % moteus::kExtras);
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    if (!send(moteus::query(node_of(j), asked_))) continue;
    answers_.asked(j);
    if (j + 1 == rt::kJoints) answers_.asked(AnswerSet::kButtons);  // the module answers the query to the last drive
    nodes_[j].asked_when_off = nodes_[j].is_told_off;
    nodes_[j].asked_when_on = phase_ != Phase::kOff;
  }
}

void MoteusLink::drain() noexcept {
  bus_.drain([this](const can::Frame& frame) noexcept { take(frame); });
}

/// A refused frame is a lost bus: if torques were refused and queries not, an old torque could act on and on.
bool MoteusLink::send(const can::Frame& frame) noexcept {
  const bool is_taken = bus_.send(frame);
  if (!is_taken) bus_.lose();
  return is_taken;
}

void MoteusLink::take(const can::Frame& frame) noexcept {
  if (foreign_ == rt::Foreign::kNone) foreign_ = moteus::foreign_kind(frame);
  if (const auto joint = moteus::joint_of(frame)) return take_reply(*joint, frame);
  if (frame.id != moteus::kButtonsId || frame.dlc != ButtonModule::kBytes) return;
  if (answers_.take(AnswerSet::kButtons) != AnswerSet::Answer::kInTime) return;
  // The module's counter is the register that was asked for, so it names the request as a drive's answer does
  if (buttons_.take(frame) && buttons_.life() == moteus::register_of(asked_)) take_part(AnswerSet::kButtons);
}

void MoteusLink::take_reply(std::size_t joint, const can::Frame& frame) noexcept {
  const auto reply = moteus::read_reply(frame);
  if (!reply) return;
  Node& node = nodes_[joint];
  const auto answer = answers_.take(joint);
  node.tells_unasked = node.tells_unasked || answer == AnswerSet::Answer::kUnasked;
  node.last = reply;
  judge(node, *reply);
  if (answer != AnswerSet::Answer::kInTime || reply->extra != asked_) return;
  if (node.asked_when_off) node.is_off = moteus::is(reply->mode, Mode::kStopped);
  compare(node, *reply);
  if (!std::isfinite(reply->position_rev)) return;  // no sample, but its mode counts
  pending_[joint] = *reply;
  take_part(joint);
}

/// Looks at every answer, also at a late one: a drive that is on must stay in its mode. Answers keep their order, so
/// after one that says "on" none is older than the command.
void MoteusLink::judge(Node& node, const moteus::Reply& reply) const noexcept {
  if (reply.extra == Extra::kHome) {
    node.is_lost = node.is_lost || (node.home && *node.home != reply.extra_value);
    if (!node.home) node.home = reply.extra_value;
  }
  if (phase_ == Phase::kOff) return;
  const bool is_on = moteus::is(reply.mode, Mode::kPosition);
  const bool may_be =
      is_on || (!node.was_on && (moteus::is(reply.mode, Mode::kStopped) || moteus::is_preparing(reply.mode)));
  const bool has_fault = reply.fault != 0 && !moteus::is_limit(reply.fault);
  node.has_failed = node.has_failed || !may_be || node.is_lost || (is_on && has_fault);
  node.was_on = node.was_on || is_on;
}

/// A drive that is on tells back what it was commanded, one setting in each period. A drive that has started anew, or
/// has lost a command, has other settings.
void MoteusLink::compare(Node& node, const moteus::Reply& reply) const noexcept {
  if (!node.asked_when_on || !moteus::is(reply.mode, Mode::kPosition)) return;
  bool is_right = false;
  switch (reply.extra) {
    case Extra::kHome:
      is_right = !node.is_lost && reply.extra_value != moteus::kHomeUnknown;
      break;
    case Extra::kMaxTorque:
      is_right = reply.extra_value == limits_.max_torque_Nm;
      break;
    case Extra::kWatchdog:
      is_right = reply.extra_value == limits_.watchdog_s;
      break;
    case Extra::kKpScale:
    case Extra::kKdScale:
    case Extra::kIlimitScale:
      is_right = reply.extra_value == 0.0F;
      break;
  }
  node.has_failed = node.has_failed || !is_right;
  if (is_right) node.confirmed |= 1U << static_cast<unsigned>(reply.extra);
}

void MoteusLink::take_part(std::size_t part) noexcept {
  if (!answers_.add(part)) return;
  used_ = pending_;
  buttons_.use();
}

bool MoteusLink::is_on() const noexcept {
  return phase_ != Phase::kOff && std::ranges::all_of(nodes_, [](const Node& node) { return node.is_on(); });
}

rt::HandReading MoteusLink::reading() const noexcept {
  rt::HandReading r;
  bus_.tell(r);
  r.foreign = foreign_;
  r.valid = answers_.is_valid();
  r.age_ticks = answers_.age_ticks();
  r.enabled = r.valid && is_on();
  buttons_.tell(r);
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const Node& node = nodes_[j];
    r.q_rad[j] = static_cast<double>(used_[j].position_rev) * kRad_per_rev;
    // A drive that damps after its watchdog is a fault by its mode
    if (r.valid && !moteus::is(used_[j].mode, Mode::kTimeout))
      r.measured_Nm[j] = static_cast<double>(used_[j].torque_Nm);
    // Without its torque nobody would see one of its own
    r.torque_astray[j] = r.valid && moteus::is(used_[j].mode, Mode::kPosition) && !std::isfinite(used_[j].torque_Nm);
    r.torque_limited[j] = moteus::is_limit(used_[j].fault);
    const bool has_failed = node.has_failed || node.is_lost || node.tells_unasked;
    r.tell_drive(j, {node.is_on(), answers_.is_missing(j), has_failed, node.error()});
  }
  r.tell_drive(rt::HandReading::kButtonModule, {.is_silent = answers_.is_missing(AnswerSet::kButtons)});
  return r;
}

std::int16_t MoteusLink::permille_of(double torque_Nm) const noexcept {
  return static_cast<std::int16_t>(can::round_clipped(torque_Nm / Nm_per_permille_, max_permille_));
}

bool MoteusLink::may_switch_on() const noexcept {
  return std::ranges::all_of(nodes_, [](const Node& node) { return node.is_off && !node.is_lost; });
}

/// Stop is sent again in each period: a drive that missed it, or whose frame the bus refused, must get the next one. It
/// feeds no watchdog, and ends the damping after a watchdog that ran out.
void MoteusLink::switch_off() noexcept {
  phase_ = Phase::kOff;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    Node& node = nodes_[j];
    const bool is_sent = send(moteus::stop(node_of(j)));
    node.is_told_off = is_sent || node.is_told_off;
  }
}

void MoteusLink::forget_off() noexcept {
  for (Node& node : nodes_) node.is_told_off = node.is_off = node.asked_when_off = false;
}

void MoteusLink::begin_switching() noexcept {
  forget_off();
  phase_ = Phase::kSwitching;
  switching_periods_ = 0;
  for (Node& node : nodes_) {
    node.confirmed = 0;
    node.asked_when_on = node.was_on = node.has_failed = false;
  }
}

/// Drives are switched on only after all have said that they are off. They get no torque before all are on and have
/// told back what they were commanded.
std::array<std::int16_t, rt::kJoints> MoteusLink::write(const rt::HandCommand& command) noexcept {
  std::array<std::int16_t, rt::kJoints> sent{};
  bus_.forget_loss();
  for (Node& node : nodes_) node.tells_unasked = false;
  const bool wants_on = command.request == rt::DriveRequest::kEnable || command.request == rt::DriveRequest::kOperate;
  const bool has_failed = std::ranges::any_of(nodes_, &Node::has_failed) && phase_ != Phase::kOff;
  if (has_failed || (phase_ == Phase::kSwitching && ++switching_periods_ > kPatience)) pause_periods_ = kPause;
  pause_periods_ = std::max(pause_periods_ - 1, 0);
  if (wants_on && foreign_ == rt::Foreign::kNone && pause_periods_ == 0) {
    if (phase_ == Phase::kOff && command.request == rt::DriveRequest::kEnable && may_switch_on()) begin_switching();
    if (phase_ == Phase::kSwitching && is_on()) phase_ = Phase::kOn;
  }
  if (!wants_on || foreign_ != rt::Foreign::kNone || pause_periods_ > 0 || phase_ == Phase::kOff) {
    switch_off();
    return sent;
  }
  const bool has_torque = phase_ == Phase::kOn && command.request == rt::DriveRequest::kOperate;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const std::int16_t torque = has_torque ? permille_of(command.torque_Nm[j]) : std::int16_t{0};
    if (send(moteus::torque(node_of(j), static_cast<float>(torque * Nm_per_permille_), limits_))) sent[j] = torque;
  }
  return sent;
}

}  // namespace ligature::platform
