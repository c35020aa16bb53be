#include "firmware/control/hand_control.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ligature::control {

HandControl::HandControl(const device::Device& d, const scene::Hands& hands, double period_s) noexcept
    : period_s_(period_s),
      quantum_Nm_(d.Nm_per_permille()),
      max_torque_Nm_(d.max_torque_Nm()),
      count_rad_(d.rad_per_count()),
      linkage_(d),
      map_(hands, linkage_.home_m()),
      coupling_(hands, period_s),
      limiter_(d, hands.max_force_N, period_s),
      passivity_(d, period_s, hands.passivity, hands.energy_credit_J),
      brake_(period_s),
      velocity_{WindowVelocity(period_s, count_rad_), WindowVelocity(period_s, count_rad_),
                WindowVelocity(period_s, count_rad_)} {
  state_.p_WT = map_.origin_W_m;
  proxy_.p_WP = state_.p_WT;
}

void HandControl::change_hands(const scene::Hands& hands) noexcept {
  map_ = WorkspaceMap(hands, linkage_.home_m());
  coupling_ = VirtualCoupling(hands, period_s_);
  limiter_.set_peak(hands.max_force_N);
  passivity_.set_active(hands.passivity);
  if (sample_tick_ < 0)
    state_.p_WT = map_.origin_W_m;
  else
    map(p_DT_);
  proxy_ = {state_.p_WT, state_.v_WT};
}

void HandControl::map(const Vec3& p_DT) noexcept {
  state_.p_WT = map_.position(p_DT);
  state_.v_WT = map_.velocity(v_DT_);
}

void HandControl::observe(const rt::HandReading& reading, const Grasp& grasp, std::int64_t tick,
                          std::int64_t last_tick) noexcept {
  const bool clutch = reading.clutch || clutch_command_;
  if (!clutch) state_.grip = reading.grip;  // a parked tool keeps hold of what it holds
  state_.dead_man = reading.dead_man;
  state_.bus_load = reading.bus_load;
  if (!reading.valid) return;

  // Age counts executed periods: one period old means sampled in the last one that was executed.
  const std::int64_t sampled = reading.age_ticks == 0 ? tick : last_tick - (reading.age_ticks - 1);
  const bool same =
      reading.age_ticks == last_age_ + 1;  // one executed period older: whatever lost periods make of `sampled`
  last_age_ = reading.age_ticks;
  if (sample_tick_ < 0 || (!same && sampled > sample_tick_)) sample(reading, sampled);
  state_.age_ticks = tick - sample_tick_;
  step_clutch(clutch, p_DT_);
  if (!state_.clutch) map(p_DT_);

  holds_ = grasp.held;
  const auto pull = coupling_.pull(grasp, state_.p_WT, state_.v_WT, proxy_);
  state_.f_wish_N = pull.f_N;
  finite_ = pull.finite && state_.p_WT.allFinite() && state_.v_WT.allFinite();
}

void HandControl::sample(const rt::HandReading& reading, std::int64_t sampled) noexcept {
  state_.q_rad = reading.q_rad;
  p_DT_ = linkage_.position(reading.q_rad);
  jacobian_ = linkage_.jacobian(reading.q_rad);
  const std::int64_t periods = sample_tick_ < 0 ? 0 : sampled - sample_tick_;
  Vec3 rate;
  for (std::size_t j = 0; j < velocity_.size(); ++j) {
    velocity_[j].add(reading.q_rad[j], periods);
    rate[static_cast<Eigen::Index>(j)] = velocity_[j].velocity_per_s();
  }
  v_DT_ = jacobian_ * rate;
  std::array<double, 3> counts{};
  for (std::size_t j = 0; j < counts.size(); ++j) counts[j] = std::round(reading.q_rad[j] / count_rad_);
  encoder_fault_ = watch_.add(counts, periods, linkage_.far_from_stops(reading.q_rad));
  sample_tick_ = sampled;
  if (p_DT_.allFinite())
    passivity_.observe(sampled, reading.q_rad, p_DT_, count_rad_ * jacobian_.colwise().norm().maxCoeff());
}

/// While it is held the tool stays where it is in the world; when it is let go, the map is moved so that the tool
/// still is there. The hand's force is taken by the gain in between, and comes back by it: nothing jumps.
void HandControl::step_clutch(bool pressed, const Vec3& p_DT) noexcept {
  if (pressed && !state_.clutch) state_.v_WT = Vec3::Zero();
  if (!pressed && state_.clutch) map_.origin_W_m += state_.p_WT - map_.position(p_DT);
  state_.clutch = pressed;
}

std::array<double, rt::kJoints> HandControl::command(Push push, std::int64_t tick) noexcept {
  const Vec3 wish_N = push == Push::kBrake ? brake_force() : state_.f_wish_N;
  braking_ = push == Push::kBrake;
  std::int16_t limits = push == Push::kBrake ? rt::kVelocityBrake : 0;
  Vec3 torque_Nm = Vec3::Zero(), f_N = Vec3::Zero();
  if (push != Push::kNone && finite_) {
    const Vec3 limited_N = limiter_.limit(gain() * wish_N);
    limits = static_cast<std::int16_t>(limits | limiter_.codes());
    const Vec3 paid_N = passivity_.control(tick, limited_N, v_DT_);
    torque_Nm = sendable_torque(paid_N, tick);
    f_N = torque_Nm.isZero(0.0) ? Vec3(Vec3::Zero()) : tip_force(torque_Nm, paid_N);
    if (passivity_.acts()) limits |= rt::kPassivityLimit;
    if (torque_clipped_) limits |= rt::kTorqueLimit;
    state_.f_device_N = torque_Nm.isZero(0.0) ? f_N : paid_N;
  } else {
    state_.f_device_N = Vec3::Zero();
  }
  passivity_.sent(tick, torque_Nm, f_N);
  limiter_.sent(state_.f_device_N);
  fill_state(limits);
  return {torque_Nm[0], torque_Nm[1], torque_Nm[2]};
}

Vec3 HandControl::brake_force() noexcept {
  if (!braking_) brake_.start(p_DT_, v_DT_);
  brake_.step();
  return kBrake_N_per_m * (brake_.position_m() - p_DT_) + kBrake_N_s_per_m * (brake_.velocity_m_per_s() - v_DT_);
}

/// J^T f in whole torque quanta, within the drives' range, and never more than the port can pay for.
Vec3 HandControl::sendable_torque(const Vec3& f_N, std::int64_t tick) noexcept {
  const Vec3 exact = jacobian_.transpose() * f_N;
  const Vec3 clipped = exact.cwiseMax(-max_torque_Nm_).cwiseMin(max_torque_Nm_);
  torque_clipped_ = clipped != exact;
  const Vec3 nearest = clipped.unaryExpr([this](double t) { return quantum_Nm_ * std::round(t / quantum_Nm_); });
  if (passivity_.allows(tick, tip_force(nearest, f_N))) return nearest;
  const Vec3 less = clipped.unaryExpr([this](double t) { return quantum_Nm_ * std::trunc(t / quantum_Nm_); });
  return passivity_.allows(tick, tip_force(less, f_N)) ? less : Vec3(Vec3::Zero());
}

/// Tip force that joint torques make: J^-T tau. Where the arm is nearly singular, the force they were made from.
Vec3 HandControl::tip_force(const Vec3& torque_Nm, const Vec3& otherwise_N) const noexcept {
  const Vec3 f_N = jacobian_.transpose().inverse() * torque_Nm;
  return f_N.allFinite() && f_N.norm() < 10.0 * otherwise_N.norm() + 0.1 ? f_N : otherwise_N;
}

void HandControl::fill_state(std::int16_t limits) noexcept {
  state_.gain = gain();
  state_.limits = limits;
  state_.limited = (limits & (rt::kPeakLimit | rt::kContinuousLimit)) != 0 && gain() >= 1.0;
  state_.heat = limiter_.heat();
  state_.port_energy_J = passivity_.energy_J();
  state_.dissipated_J = passivity_.dissipated_J();
  state_.injected_N_s_per_m = passivity_.injected_N_s_per_m();
}

}  // namespace ligature::control
