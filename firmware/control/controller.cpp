#include "firmware/control/controller.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::control {
namespace {

rt::Culprit part_of(std::size_t h, std::int8_t joint = -1, std::uint32_t error = 0) noexcept {
  return {static_cast<std::int8_t>(h), joint, error};
}

rt::Culprit drive_of(std::size_t h, const rt::HandReading& reading) noexcept {
  return part_of(h, reading.bad_joint, reading.drive_error);
}

}  // namespace

Controller::Controller(const scene::Hands& hands, const Settings& settings) noexcept
    : settings_(settings),
      hands_{HandControl(settings.device, hands, kPeriod_s), HandControl(settings.device, hands, kPeriod_s)},
      torque_{TorqueWatch(settings.device, settings.watchdog_ticks),
              TorqueWatch(settings.device, settings.watchdog_ticks)},
      loss_{LossWatch(settings.watchdog_ticks), LossWatch(settings.watchdog_ticks)},
      scale_goal_(hands.force_scale),
      armed_(settings.armed) {}

void Controller::command(rt::CommandKind kind) noexcept {
  switch (kind) {
    case rt::CommandKind::kArm:
      armed_ = state_ != State::kFault;
      break;
    case rt::CommandKind::kDisarm:
      armed_ = false;
      break;
    case rt::CommandKind::kStop:
      armed_ = false;
      stop_requested_ = true;
      for (HandControl& h : hands_) h.drop(), h.need_new_press();
      break;
    case rt::CommandKind::kResetFault:
      reset_requested_ = true;
      break;
    case rt::CommandKind::kClutchLeft:
    case rt::CommandKind::kUnclutchLeft:
      hands_[0].hold_clutch(kind == rt::CommandKind::kClutchLeft);
      break;
    case rt::CommandKind::kClutchRight:
    case rt::CommandKind::kUnclutchRight:
      hands_[1].hold_clutch(kind == rt::CommandKind::kClutchRight);
      break;
    case rt::CommandKind::kPark:
    case rt::CommandKind::kCalibrate:
      begin_moves(kind == rt::CommandKind::kPark ? Move::kPark : Move::kCalibrate);
      break;
    case rt::CommandKind::kResetThread:  // handled by the physics thread
    case rt::CommandKind::kNone:
      break;
  }
}

/// Starts a guided move of each hand whose dead-man is pressed and whose gripper holds nothing; other hands do not
/// move. While the clutch is pressed, the move ends at once (HandControl::lead_force()).
void Controller::begin_moves(Move move) noexcept {
  if (!armed_ || !may_push(state_) || braking_) return;
  for (HandControl& h : hands_) {
    if (h.dead_man_counts() && !h.holds()) h.begin_move(move);
  }
}

void Controller::change_hands(const scene::Hands& hands) noexcept {
  for (HandControl& h : hands_) h.change_hands(hands);
  scale_goal_ = hands.force_scale;
}

void Controller::change_force_scale(double force_scale) noexcept {
  scale_goal_ = force_scale;
  scale_step_ = std::abs(force_scale - hands_[0].force_scale()) / kScaleTicks;
}

void Controller::step_force_scale() noexcept {
  const double now = hands_[0].force_scale(), left = scale_goal_ - now;
  if (left == 0.0) return;
  // Set exactly, so that rounding errors of the steps do not remain
  const bool arrives = std::abs(left) <= scale_step_ * (1.0 + 1e-9);
  for (HandControl& h : hands_) h.set_force_scale(arrives ? scale_goal_ : now + std::copysign(scale_step_, left));
}

rt::RigCommand Controller::tick(const TickInput& in) noexcept {
  step_force_scale();
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    if (in.late) hands_[h].doubt_time_of(in.tick);
    age_[h].look(in.reading.hand[h], in.tick, last_tick_);
    torque_[h].look(in.reading.hand[h], age_[h].is_fresh());
    loss_[h].look(in.reading.hand[h], age_[h].is_fresh());
    if (state_ == State::kOff) loss_[h].forget();  // drives are starting up, or a fault was reset
    hands_[h].observe(in.reading.hand[h], age_[h], in.grasp[h], in.tick);
  }
  step_state(in);
  step_gains();
  last_tick_ = in.tick;
  reset_requested_ = false;

  rt::RigCommand command;
  for (HandControl& h : hands_) h.decide(push(h));
  if (settings_.lending && hands_[0].holds() && hands_[1].holds()) HandControl::lend(in.tick, hands_[0], hands_[1]);
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    command.hand[h].torque_Nm = hands_[h].command(in.tick);
    command.hand[h].request = drive_request();
    torque_[h].sent(command.hand[h].torque_Nm);
  }
  stop_requested_ = false;
  const bool off = state_ == State::kOff || state_ == State::kFault;
  powered_down_ticks_ = shutting_down_ && off ? powered_down_ticks_ + 1 : 0;
  return command;
}

Push Controller::push(const HandControl& hand) const noexcept {
  if (!may_push(state_) || stop_requested_) return Push::kNone;
  if (braking_) return Push::kBrake;
  return hand.is_led() ? Push::kLead : Push::kCoupling;
}

bool Controller::any_too_fast() const noexcept {
  return std::ranges::any_of(
      hands_, [this](const HandControl& h) { return h.speed_m_per_s() > settings_.device.velocity_limit_m_per_s; });
}

/// The most specific fault of this tick. In the state OFF, while the drives start up, only faults that do not need
/// running drives count.
Controller::Found Controller::find_fault(const TickInput& in) const noexcept {
  const auto& hands = in.reading.hand;
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    if (hands[h].bus_lost) return {Fault::kBusLost, part_of(h)};
  }
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    const Fault foreign = fault_of(hands[h].foreign);
    if (foreign != Fault::kNone) return {foreign, part_of(h)};
    if (torque_[h].is_astray()) return {Fault::kTorqueAstray, part_of(h, torque_[h].joint())};
  }
  if (!in.thread_finite) return {Fault::kPhysicsDiverged};
  if (last_tick_ >= 0 && in.tick - last_tick_ - 1 >= settings_.watchdog_ticks) return {Fault::kOverrun};
  if (in.thread_late_ticks >= settings_.watchdog_ticks) return {Fault::kThreadLate};
  if (state_ == State::kOff) return {};
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    if (const Found found = find_hand_fault(h, hands[h]); found.fault != Fault::kNone) return found;
    if (loss_[h].is_lossy()) return {Fault::kFramesLost, part_of(h)};
  }
  return {};
}

Controller::Found Controller::find_hand_fault(std::size_t h, const rt::HandReading& reading) const noexcept {
  const HandControl& hand = hands_[h];
  if (age_[h].is_too_old(settings_.watchdog_ticks)) return {Fault::kTpdoTooOld, drive_of(h, reading)};
  if (reading.drive_fault || !reading.enabled) return {Fault::kDriveFault, drive_of(h, reading)};
  if (reading.buttons_stuck) return {Fault::kButtonsStuck, part_of(h)};
  const JointFault encoder = hand.encoder_fault();
  if (encoder.fault != Fault::kNone) return {encoder.fault, part_of(h, encoder.joint)};
  if (!hand.is_finite()) return {Fault::kNonFinite, part_of(h)};
  if (hand.overtime_ticks() >= kMostOvertimeTicks) return {Fault::kForceStays, part_of(h)};
  if (hand.speed_m_per_s() > kVelocityFault * settings_.device.velocity_limit_m_per_s)
    return {hand.is_catching_up() ? Fault::kSamplesBurst : Fault::kVelocityLimit, part_of(h)};
  return {};
}

bool Controller::is_up(std::size_t h, const rt::HandReading& reading) const noexcept {
  return age_[h].is_of_this_period() && reading.enabled && !reading.drive_fault;
}

/// What keeps the rig in OFF, or in CALIBRATE: the first hand whose drives are not up, or whose pose is impossible.
rt::Culprit Controller::find_wait(const rt::RigReading& reading) const noexcept {
  for (std::size_t h = 0; h < rt::kHands && !shutting_down_; ++h) {
    if (state_ == State::kOff && !is_up(h, reading.hand[h])) return drive_of(h, reading.hand[h]);
    if (state_ == State::kCalibrate && !hands_[h].is_plausible()) return part_of(h);
  }
  return {};
}

void Controller::step_state(const TickInput& in) noexcept {
  if (state_ == State::kFault) {
    for (HandControl& h : hands_) h.need_new_press();
    if (!reset_requested_ || needs_restart(fault_)) return;
    fault_ = Fault::kNone;
    culprit_ = {};
    for (HandControl& h : hands_) h.restart_account();
    state_ = next(state_, Event::kReset);
    return;
  }
  if (const Found found = find_fault(in); found.fault != Fault::kNone) {
    fault_ = found.fault;
    culprit_ = found.culprit;
    armed_ = false;
    state_ = next(state_, Event::kFault);
    return;
  }
  const bool brakes = !all_zero() && any_too_fast();  // without force there is nothing to brake
  if (state_ != State::kBrake) braking_ = brakes;
  const bool plausible = state_ == State::kCalibrate && std::ranges::all_of(hands_, &HandControl::is_plausible);
  plausible_ticks_ = plausible ? plausible_ticks_ + 1 : 0;
  if (const auto event = find_event(in.reading, brakes)) state_ = next(state_, *event);
  culprit_ = find_wait(in.reading);
}

std::optional<Event> Controller::find_event(const rt::RigReading& reading, bool brakes) const noexcept {
  const bool push = armed_ && !shutting_down_;
  switch (state_) {
    case State::kOff:
      if (!shutting_down_ && is_up(0, reading.hand[0]) && is_up(1, reading.hand[1])) return Event::kDrivesUp;
      break;
    case State::kCalibrate:
      if (shutting_down_) return Event::kPowerDown;
      if (plausible_ticks_ >= kCalibrationTicks) return Event::kCalibrated;
      break;
    case State::kIdle:
      if (shutting_down_) return Event::kPowerDown;
      if (push) return Event::kArm;
      break;
    case State::kEngage:
      if (!push) return Event::kDisarm;
      if (brakes) return Event::kTooFast;
      if (any_full()) return Event::kEngaged;
      break;
    case State::kForce:
      if (!push) return Event::kDisarm;
      if (brakes) return Event::kTooFast;
      if (all_zero()) return Event::kLetGo;
      break;
    case State::kBrake:
      if (all_zero() && !any_pushes()) return Event::kStopped;
      break;
    case State::kFault:
      break;
  }
  return std::nullopt;
}

void Controller::step_gains() noexcept {
  for (HandControl& h : hands_) {
    if (!may_push(state_)) {
      h.drop();
      continue;
    }
    const bool wanted = state_ != State::kBrake && armed_ && h.dead_man_counts();
    if (!wanted) h.end_move();
    h.step_gain(wanted);
  }
}

rt::DriveRequest Controller::drive_request() const noexcept {
  if (state_ == State::kFault) return needs_restart(fault_) ? rt::DriveRequest::kStop : rt::DriveRequest::kHold;
  if (state_ == State::kOff) return shutting_down_ ? rt::DriveRequest::kHold : rt::DriveRequest::kEnable;
  return rt::DriveRequest::kOperate;
}

bool Controller::any_full() const noexcept {
  return std::ranges::any_of(hands_, [](const HandControl& h) { return h.gain() >= 1.0; });
}

bool Controller::all_zero() const noexcept {
  return std::ranges::all_of(hands_, [](const HandControl& h) { return h.gain() == 0.0; });
}

/// Whether any hand still has a force. A force can outlast its gain, because its change per tick is limited.
bool Controller::any_pushes() const noexcept {
  return std::ranges::any_of(hands_, [](const HandControl& h) { return !h.state().f_device_N.isZero(0.0); });
}

std::array<physics::ToolInput, rt::kHands> Controller::tools() const noexcept {
  // A hand without fresh samples releases the thread.
  const auto tool = [this](std::size_t h) { return hands_[h].tool(!age_[h].is_too_old(settings_.watchdog_ticks)); };
  return {tool(0), tool(1)};
}

}  // namespace ligature::control
