#include "firmware/control/controller.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::control {

Controller::Controller(const scene::Hands& hands, const Settings& settings) noexcept
    : map_(hands), coupling_(hands), scale_goal_(hands.force_scale), settings_(settings), armed_(settings.armed) {
  for (Hand& h : hands_) h.state.p_WT = map_.origin_W_m;
}

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
      for (Hand& h : hands_) h.engagement.drop();
      break;
    case rt::CommandKind::kResetFault:
      reset_requested_ = true;
      break;
    case rt::CommandKind::kResetThread:  // the thread's, not ours
    case rt::CommandKind::kNone:
      break;
  }
}

void Controller::change_hands(const scene::Hands& hands) noexcept {
  map_ = WorkspaceMap(hands);
  coupling_ = VirtualCoupling(hands);
  scale_goal_ = hands.force_scale;
  for (Hand& h : hands_) {
    h.state.p_WT = h.sample_tick < 0 ? map_.origin_W_m : map_.position(tip_position(h.q_rad));
    h.state.v_WT = map_.velocity(h.v_DT);
  }
}

void Controller::change_force_scale(double force_scale) noexcept {
  scale_goal_ = force_scale;
  scale_step_ = std::abs(force_scale - coupling_.force_scale()) / kScaleTicks;
}

void Controller::step_force_scale() noexcept {
  const double left = scale_goal_ - coupling_.force_scale();
  const bool arrives = std::abs(left) <= scale_step_ * (1.0 + 1e-9);  // exactly, whatever the steps added up to
  if (left == 0.0) return;
  coupling_.set_force_scale(arrives ? scale_goal_ : coupling_.force_scale() + std::copysign(scale_step_, left));
}

rt::RigCommand Controller::tick(const TickInput& in) noexcept {
  step_force_scale();
  for (std::size_t h = 0; h < rt::kHands; ++h) observe(hands_[h], in.reading.hand[h], in.grasp[h], in.tick);
  step_state(in);
  step_gains();
  last_tick_ = in.tick;
  reset_requested_ = false;

  rt::RigCommand command;
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    Hand& hand = hands_[h];
    hand.state.gain = hand.engagement.gain();
    hand.state.limited = hand.full_is_limited && hand.state.gain >= 1.0 && may_push(state_);
    hand.state.f_device_N = may_push(state_) ? Vec3(hand.state.gain * hand.f_full_N) : Vec3(Vec3::Zero());
    const Vec3 torque_Nm = joint_torque(hand.q_rad, hand.state.f_device_N);
    for (std::size_t j = 0; j < rt::kJoints; ++j) {
      command.hand[h].torque_Nm[j] = torque_Nm[static_cast<Eigen::Index>(j)];
    }
    command.hand[h].request = drive_request();
  }
  const bool off = state_ == State::kOff || state_ == State::kFault;
  powered_down_ticks_ = shutting_down_ && off ? powered_down_ticks_ + 1 : 0;
  return command;
}

/// Joints to tip to world, and the force that this pose would get at full gain. An old sample is held as it is.
void Controller::observe(Hand& hand, const rt::HandReading& reading, const Grasp& grasp, std::int64_t tick) noexcept {
  HandState& s = hand.state;
  s.grip = reading.grip;
  s.dead_man = reading.dead_man;
  if (!reading.valid) return;

  // Age counts executed periods: one period old means sampled in the last one that was executed.
  const std::int64_t sampled = reading.age_ticks == 0 ? tick : last_tick_ - (reading.age_ticks - 1);
  if (hand.sample_tick < 0 || sampled > hand.sample_tick) {
    hand.q_rad = reading.q_rad;
    const Vec3 p_DT = tip_position(reading.q_rad);
    hand.velocity.add(p_DT, hand.sample_tick < 0 ? 0 : sampled - hand.sample_tick);
    hand.v_DT = hand.velocity.velocity_m_per_s();
    hand.sample_tick = sampled;
    s.p_WT = map_.position(p_DT);
    s.v_WT = map_.velocity(hand.v_DT);
  }
  s.age_ticks = tick - hand.sample_tick;
  const LimitedForce force = coupling_.force(grasp, s.p_WT, s.v_WT);
  hand.f_full_N = force.f_N;
  hand.finite = force.finite && s.p_WT.allFinite() && s.v_WT.allFinite();
  hand.full_is_limited = force.limited;
}

/// The fault of this tick, the most telling first. While the drives are on their way up (OFF) only a lost bus counts.
Fault Controller::find_fault(const TickInput& in) const noexcept {
  for (const auto& reading : in.reading.hand) {
    if (reading.bus_lost) return Fault::kBusLost;
  }
  if (!in.thread_finite) return Fault::kPhysicsDiverged;
  if (last_tick_ >= 0 && in.tick - last_tick_ - 1 >= settings_.watchdog_ticks) return Fault::kOverrun;
  if (state_ == State::kOff) return Fault::kNone;
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    const Fault fault = find_hand_fault(hands_[h], in.reading.hand[h]);
    if (fault != Fault::kNone) return fault;
  }
  return Fault::kNone;
}

Fault Controller::find_hand_fault(const Hand& hand, const rt::HandReading& reading) const noexcept {
  if (hand.state.age_ticks >= settings_.watchdog_ticks) return Fault::kTpdoTooOld;
  if (reading.drive_fault || !reading.enabled) return Fault::kDriveFault;
  if (!hand.finite) return Fault::kNonFinite;
  if (hand.v_DT.norm() > kVelocityLimit_m_per_s) return Fault::kVelocityLimit;
  return Fault::kNone;
}

bool Controller::drives_are_up(const rt::RigReading& reading) const noexcept {
  return std::ranges::all_of(reading.hand, [](const rt::HandReading& r) {
    return r.valid && r.enabled && !r.drive_fault && r.age_ticks == 0;
  });
}

void Controller::step_state(const TickInput& in) noexcept {
  if (state_ == State::kFault) {
    if (!reset_requested_) return;
    fault_ = Fault::kNone;
    state_ = next(state_, Event::kReset);
    return;
  }
  if (const Fault fault = find_fault(in); fault != Fault::kNone) {
    fault_ = fault;
    armed_ = false;
    state_ = next(state_, Event::kFault);
    return;
  }
  const bool push = armed_ && !shutting_down_;
  switch (state_) {
    case State::kOff:
      plausible_ticks_ = 0;
      if (!shutting_down_ && drives_are_up(in.reading)) state_ = next(state_, Event::kDrivesUp);
      break;
    case State::kCalibrate: {
      const bool plausible = std::ranges::all_of(hands_, [](const Hand& h) { return is_plausible(h.q_rad); });
      plausible_ticks_ = plausible ? plausible_ticks_ + 1 : 0;
      if (shutting_down_)
        state_ = next(state_, Event::kPowerDown);
      else if (plausible_ticks_ >= kCalibrationTicks)
        state_ = next(state_, Event::kCalibrated);
      break;
    }
    case State::kIdle:
      if (shutting_down_)
        state_ = next(state_, Event::kPowerDown);
      else if (push)
        state_ = next(state_, Event::kArm);
      break;
    case State::kEngage:
      if (!push)
        state_ = next(state_, Event::kDisarm);
      else if (any_full())
        state_ = next(state_, Event::kEngaged);
      break;
    case State::kForce:
      if (!push)
        state_ = next(state_, Event::kDisarm);
      else if (all_zero())
        state_ = next(state_, Event::kLetGo);
      break;
    case State::kBrake:
      if (all_zero()) state_ = next(state_, Event::kStopped);
      break;
    case State::kFault:
      break;
  }
}

void Controller::step_gains() noexcept {
  for (Hand& h : hands_) {
    if (!may_push(state_)) {
      h.engagement.drop();
      continue;
    }
    const bool wanted = state_ != State::kBrake && armed_ && h.state.dead_man;
    h.engagement.tick(wanted, h.v_DT.norm(), h.f_full_N.norm());
  }
}

rt::DriveRequest Controller::drive_request() const noexcept {
  if (state_ == State::kFault) return rt::DriveRequest::kHold;
  if (state_ == State::kOff) return shutting_down_ ? rt::DriveRequest::kHold : rt::DriveRequest::kEnable;
  return rt::DriveRequest::kOperate;
}

bool Controller::any_full() const noexcept {
  return std::ranges::any_of(hands_, [](const Hand& h) { return h.engagement.gain() >= 1.0; });
}

bool Controller::all_zero() const noexcept {
  return std::ranges::all_of(hands_, [](const Hand& h) { return h.engagement.gain() == 0.0; });
}

std::array<physics::ToolInput, rt::kHands> Controller::tools() const noexcept {
  std::array<physics::ToolInput, rt::kHands> tools;
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    const HandState& s = hands_[h].state;
    const bool alive = s.age_ticks < settings_.watchdog_ticks;  // a hand that is gone lets go of the thread
    tools[h] = {s.p_WT, s.v_WT, s.grip && alive};
  }
  return tools;
}

}  // namespace ligature::control
