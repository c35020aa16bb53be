#include "firmware/platform/odrive_link.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "protocol/can/units.hpp"

namespace ligature::platform {
namespace {

constexpr int kMany = std::numeric_limits<int>::max() - 1;
constexpr double kRad_per_rev = 2.0 * std::numbers::pi;

constexpr unsigned node_of(std::size_t joint) noexcept { return static_cast<unsigned>(joint) + 1U; }

}  // namespace

OdriveLink::OdriveLink(CanBus& bus, const device::Device& device) noexcept
    : bus_(bus),
      Nm_per_permille_(device.Nm_per_permille()),
      max_permille_(device.max_torque_permille),
      profile_(device.odrive.value_or(device::OdriveProfile{})),
      most_current_A_(static_cast<float>(device.max_torque_Nm() / profile_.torque_constant_Nm_per_A)) {}

void OdriveLink::forget_beats() noexcept {
  for (Node& node : nodes_) node.beats = 0;
}

void OdriveLink::forget_targets() noexcept {
  for (Node& node : nodes_) node.target_Nm.reset();
}

void OdriveLink::request() noexcept {
  drain();
  bus_.begin_period();
  foreign_periods_ = std::max(foreign_periods_ - 1, 0);
  for (Node& node : nodes_) {
    node.silent = std::min(node.silent + 1, kMany);
    node.was_away = node.was_away || node.silent > kMissedBeats * profile_.heartbeat_ms;
  }
  if (answers_.begin_period(may_ask_)) ask_all();
}

void OdriveLink::ask_all() noexcept {
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    if (!send(odrive::ask(node_of(j), odrive::Command::kEstimates))) continue;
    answers_.asked(j);
    if (j + 1 == rt::kJoints) answers_.asked(AnswerSet::kButtons);  // the module answers the request to the last drive
  }
}

void OdriveLink::drain() noexcept {
  bus_.drain([this](const can::Frame& frame) noexcept { take(frame); });
}

/// A refused frame is a lost bus: if torques were refused and requests not, an old torque could act on and on.
bool OdriveLink::send(const can::Frame& frame) noexcept {
  if (bus_.send(frame)) return true;
  has_refused_ = true;
  bus_.lose();
  return false;
}

bool OdriveLink::send_limits(std::size_t joint) noexcept {
  return send(
      odrive::set_limits(node_of(joint), static_cast<float>(profile_.velocity_limit_rev_per_s), most_current_A_));
}

void OdriveLink::take(const can::Frame& frame) noexcept {
  if (const auto kind = odrive::foreign_kind(frame); kind != rt::Foreign::kNone) {
    foreign_periods_ = kNear;
    if (foreign_ == rt::Foreign::kNone) foreign_ = kind;
  }
  if (frame.id == profile_.buttons_id) return take_buttons(frame);
  const auto address = odrive::address_of(frame.id);
  if (!address) return;
  Node& node = nodes_[address->joint];
  const auto number = odrive::read_number(frame);
  switch (address->command) {
    case odrive::Command::kHeartbeat:
      return take_beat(node, frame);
    case odrive::Command::kGetVersion:
      node.is_new = odrive::is_supported(frame);
      return;
    case odrive::Command::kGetTorques:
      node.target_Nm = number;
      return;
    case odrive::Command::kEstimates: {
      const auto answer = answers_.take(address->joint);
      node.tells_unasked = node.tells_unasked || answer == AnswerSet::Answer::kUnasked;
      if (!number || answer != AnswerSet::Answer::kInTime) return;
      node.answers = true;
      pending_rev_[address->joint] = *number;
      return take_part(address->joint);
    }
    default:
      return;
  }
}

void OdriveLink::take_beat(Node& node, const can::Frame& frame) noexcept {
  const auto beat = odrive::read_heartbeat(frame);
  if (!beat) return;
  node.heartbeat = *beat;
  node.silent = 0;
  node.beats = std::min(node.beats + 1, kMany);
  node.had_error = node.had_error || beat->error != 0;
  node.was_off = node.was_off || !node.is_on();
}

void OdriveLink::take_buttons(const can::Frame& frame) noexcept {
  if (frame.dlc != ButtonModule::kBytes || answers_.take(AnswerSet::kButtons) != AnswerSet::Answer::kInTime) return;
  if (buttons_.take(frame)) take_part(AnswerSet::kButtons);
}

void OdriveLink::take_part(std::size_t part) noexcept {
  if (!answers_.add(part)) return;
  rev_ = pending_rev_;
  buttons_.use();
}

rt::HandReading OdriveLink::reading() const noexcept {
  rt::HandReading r;
  bus_.tell(r);
  r.foreign = foreign_;
  r.valid = answers_.is_valid();
  r.age_ticks = answers_.age_ticks();
  r.enabled = r.valid;
  buttons_.tell(r);
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const Node& node = nodes_[j];
    r.q_rad[j] = rev_[j] * kRad_per_rev;
    const bool is_on = node.is_on() && !node.was_off;
    const bool has_failed = node.heartbeat.error != 0 || node.had_error || node.tells_unasked || node.was_away;
    r.tell_drive(j, {is_on, answers_.is_missing(j), has_failed, node.heartbeat.error});
  }
  r.tell_drive(rt::HandReading::kButtonModule, {.is_silent = answers_.is_missing(AnswerSet::kButtons)});
  return r;
}

std::int16_t OdriveLink::permille_of(double torque_Nm) const noexcept {
  return static_cast<std::int16_t>(can::round_clipped(torque_Nm / Nm_per_permille_, max_permille_));
}

/// A drive that was away may have been switched off and on, and then has neither its mode, its limits nor a watchdog
/// that start-up has tried. So the drives stay off until the controller is started again.
std::array<std::int16_t, rt::kJoints> OdriveLink::write(const rt::HandCommand& command) noexcept {
  std::array<std::int16_t, rt::kJoints> sent{};
  bus_.forget_loss();
  for (Node& node : nodes_) node.had_error = node.was_off = node.tells_unasked = false;
  // Another controller that comes while a fault is latched changes no request, but must find the drives stopped.
  const bool stops = command.request == rt::DriveRequest::kStop || foreign_ != rt::Foreign::kNone;
  const bool are_unsure = off_periods_ > 0 && !may_ask_;  // a torque could feed a drive that has not switched off
  if (stops || command.request == rt::DriveRequest::kHold || was_away() || are_unsure) {
    switch_off(stops);
    return sent;
  }
  off_periods_ = silent_periods_ = 0;
  may_ask_ = true;
  for (std::size_t j = 0; j < rt::kJoints; ++j) {
    const std::int16_t torque = permille_of(command.torque_Nm[j]);
    if (send(odrive::set_torque(node_of(j), static_cast<float>(torque * Nm_per_permille_)))) sent[j] = torque;
  }
  if (command.request == rt::DriveRequest::kEnable) bring_up();
  return sent;
}

/// One command a period: mode, limits and closed loop of one drive after the other. Then a pause, until the heartbeats
/// can have told the result.
void OdriveLink::bring_up() noexcept {
  const auto step = static_cast<std::size_t>(up_periods_);
  const std::size_t joint = step / 3;
  up_periods_ = up_periods_ >= 3 * static_cast<int>(rt::kJoints) + 2 * profile_.heartbeat_ms ? 0 : up_periods_ + 1;
  if (joint >= rt::kJoints || nodes_[joint].is_on()) return;
  if (step % 3 == 0) {
    is_prepared_ = nodes_[joint].heartbeat.error == 0;
    if (!is_prepared_) send(odrive::clear_errors(node_of(joint)));
  }
  if (!is_prepared_) return;
  if (step % 3 == 0) is_prepared_ = send(odrive::set_torque_mode(node_of(joint)));
  if (step % 3 == 1) is_prepared_ = send_limits(joint);
  if (step % 3 == 2) send(odrive::set_axis_state(node_of(joint), odrive::kClosedLoop));
}

/// Whether this drive has said that it is off since it was told so (in the second period).
bool OdriveLink::said_off(const Node& node) const noexcept {
  return node.heartbeat.state == odrive::kIdle && node.silent + 2 < off_periods_;
}

/// First zero torque, then idle, then silence until all drives have said that they are off. Any frame may feed a
/// drive's watchdog; in silence the watchdog of a drive that does not obey runs out. Then idle again. A stop is an
/// emergency stop instead, which only a restart clears; in every period while another controller sends, because it
/// could switch the drives on in a silence.
void OdriveLink::switch_off(bool stops) noexcept {
  const bool first = off_periods_ == 0 && foreign_ == rt::Foreign::kNone;
  off_periods_ = std::min(off_periods_ + 1, kMany);
  up_periods_ = 0;
  may_ask_ = std::ranges::all_of(nodes_, [this](const Node& node) { return said_off(node); });
  if (first) {
    for (std::size_t j = 0; j < rt::kJoints; ++j) send(odrive::set_torque(node_of(j), 0.0F));
    return;
  }
  if ((may_ask_ && !stops) || (stops && foreign_periods_ > 0)) silent_periods_ = 0;
  if ((may_ask_ && !stops) || --silent_periods_ >= 0) return;
  silent_periods_ = profile_.watchdog_ms + profile_.heartbeat_ms + kMargin;
  for (std::size_t j = 0; j < rt::kJoints; ++j)
    if (!send(stops ? odrive::estop(node_of(j)) : odrive::set_axis_state(node_of(j), odrive::kIdle)))
      silent_periods_ = 0;
}

}  // namespace ligature::platform
