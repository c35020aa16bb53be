#include "firmware/control/hand_control.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ligature::control {
namespace {

// A pose counts as singular above this tip force per joint torque (a lever arm below 2.5 mm)
constexpr double kSingular_per_m = 400.0;
constexpr std::int64_t kPause = 5;  // periods without a sample that are a pause; fewer are lost frames
constexpr double kAbove_m = 0.01;   // height of the parked tip above the workspace's floor

}  // namespace

HandControl::HandControl(const device::Device& d, const scene::Hands& hands, double period_s) noexcept
    : period_s_(period_s),
      quantum_Nm_(d.Nm_per_permille()),
      max_torque_Nm_(d.max_torque_Nm()),
      rated_Nm_(d.rated_torque_Nm),
      count_rad_(d.rad_per_count()),
      linkage_(d),
      any_pose_(d),
      map_(hands, linkage_.home_m()),
      coupling_(hands, period_s),
      limiter_(d, hands.max_force_N, period_s),
      windings_(d, period_s),
      passivity_(d, period_s, hands.passivity, hands.energy_credit_J),
      brake_(period_s),
      path_(period_s),
      park_m_(0.5 * (d.workspace_min_m[0] + d.workspace_max_m[0]), d.home_tip_m[1], d.workspace_min_m[2] + kAbove_m),
      scene_origin_W_m_(map_.origin_W_m),
      velocity_{WindowVelocity(period_s, count_rad_), WindowVelocity(period_s, count_rad_),
                WindowVelocity(period_s, count_rad_)} {
  state_.p_WT = map_.origin_W_m;
  proxy_.p_WP = state_.p_WT;
}

void HandControl::change_hands(const scene::Hands& hands) noexcept {
  map_ = WorkspaceMap(hands, linkage_.home_m());
  scene_origin_W_m_ = map_.origin_W_m;
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

void HandControl::observe(const rt::HandReading& reading, const SampleAge& age, const Grasp& grasp,
                          std::int64_t tick) noexcept {
  passivity_.begin(tick);
  const bool clutch = reading.clutch || clutch_command_;
  if (!clutch) state_.grip = reading.grip && !is_led();  // under the clutch the tool keeps its grip
  state_.dead_man = reading.dead_man;
  state_.bus_load = reading.bus_load;
  if (!reading.valid) return;

  if (age.is_fresh()) {
    dead_man_.see(reading.dead_man);
    sample(reading, age.taken());
  }
  state_.age_ticks = age.ticks();
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
  const bool timed = sampled != doubtful_tick_;
  const std::int64_t periods = sample_tick_ < 0 ? 0 : sampled - sample_tick_;
  catching_up_ = periods > kPause ? periods : std::max<std::int64_t>(catching_up_ - 1, 0);
  Vec3 rate;
  for (std::size_t j = 0; j < velocity_.size(); ++j) {
    velocity_[j].add(reading.q_rad[j], periods);
    if (!timed) velocity_[j].doubt_last_time();
    rate[static_cast<Eigen::Index>(j)] = velocity_[j].velocity_per_s();
  }
  v_DT_ = jacobian_ * rate;
  std::array<double, 3> counts{};
  for (std::size_t j = 0; j < counts.size(); ++j) counts[j] = std::round(reading.q_rad[j] / count_rad_);
  const Vec3 torque = torque_Nm_ / rated_Nm_;
  encoder_fault_ = watch_.add(counts, timed ? periods : 0, linkage_.far_from_stops(reading.q_rad),
                              {torque[0], torque[1], torque[2]});
  sample_tick_ = sampled;
  // Near a singular pose, forces computed from torques are meaningless; the inverse of the last regular pose is used
  // there.
  const Mat3 inverse = jacobian_.transpose().inverse();
  if (inverse.allFinite() && inverse.cwiseAbs().maxCoeff() < kSingular_per_m) from_torque_ = inverse;
  if (!p_DT_.allFinite()) return;
  const Acted acted{vector_of(reading.torque_Nm), reading.torque_limited, reading.torque_held};
  passivity_.observe(
      sampled, {reading.q_rad, p_DT_, count_rad_, jacobian_.colwise().norm().transpose(), rate, acted, from_torque_});
}

/// While the clutch is pressed, the tool stays at its place in the world. On release, the map from device to world is
/// shifted so that the tool does not jump. The gain fades the force out at the press and in after the release.
void HandControl::step_clutch(bool pressed, const Vec3& p_DT) noexcept {
  if (pressed && !state_.clutch) state_.v_WT = Vec3::Zero();
  if (!pressed && state_.clutch) map_.origin_W_m += state_.p_WT - map_.position(p_DT);
  state_.clutch = pressed;
}

void HandControl::decide(Push push) noexcept {
  const Vec3 wish_N = push == Push::kBrake ? brake_force() : push == Push::kLead ? lead_force() : state_.f_wish_N;
  braking_ = push == Push::kBrake;
  decided_N_ = Vec3::Zero();
  decided_limits_ = braking_ ? rt::kVelocityBrake : 0;
  lets_go_ = push == Push::kNone || !finite_;
  if (lets_go_) return;
  const Vec3 scaled_N = gain() * wish_N;
  const Vec3 torque_Nm = jacobian_.transpose() * scaled_N;
  const double size_N = std::max(scaled_N.norm(), 1e-300);
  decided_N_ = limiter_.limit(scaled_N, {safe_share(torque_Nm) * size_N, windings_.share(torque_Nm) * size_N});
  decided_limits_ = static_cast<std::int16_t>(decided_limits_ | limiter_.codes());
}

std::array<double, rt::kJoints> HandControl::command(std::int64_t tick) noexcept {
  std::int16_t limits = decided_limits_;
  Vec3 torque_Nm = Vec3::Zero(), paid_N = Vec3::Zero();
  if (!lets_go_) {
    const auto torque = [this](const Vec3& f) { return sendable_torque(f); };
    // Tip force that the last torques make in the present pose. Changes of force are counted from it, so that sending
    // the same torques again is no change.
    const Vec3 before_N = from_torque_ * torque_Nm_;
    paid_N = passivity_.control(tick, decided_N_, v_DT_, before_N, torque);
    torque_Nm = sendable_torque(paid_N);
    // Only the rounding to whole quanta can violate the step limit here; then the last torques are repeated.
    if (!passivity_.released() && !passivity_.is_a_step(torque_Nm)) torque_Nm = torque_Nm_;
    // Passivity has removed all force, because the hand exceeds the acceleration bound or frames are lost
    if (passivity_.released()) end_move();
    if (passivity_.acts()) limits |= rt::kPassivityLimit;
    if (passivity_.stepped()) limits |= rt::kStepLimit;
    const Vec3 exact_Nm = jacobian_.transpose() * paid_N;
    if (exact_Nm.lpNorm<Eigen::Infinity>() > max_torque_Nm_) limits |= rt::kTorqueLimit;
    // Passivity may have changed the force's direction, so the limits are applied again
    paid_N *= allowed_share(paid_N, exact_Nm);
  }
  if (torque_Nm.isZero(0.0)) paid_N = Vec3::Zero();
  overtime_ticks_ = gain() > 0.0 || torque_Nm.isZero(0.0) ? 0 : overtime_ticks_ + 1;
  state_.f_device_N = paid_N;
  torque_Nm_ = torque_Nm;
  passivity_.sent(tick, torque_Nm, from_torque_ * torque_Nm);
  limiter_.sent(paid_N, tick - commanded_tick_);
  windings_.sent(torque_Nm, tick - commanded_tick_);
  commanded_tick_ = tick;
  fill_state(limits);
  return {torque_Nm[0], torque_Nm[1], torque_Nm[2]};
}

Vec3 HandControl::brake_force() noexcept {
  if (braking_)
    brake_.step();
  else
    brake_.start(p_DT_, v_DT_);  // start at the present motion: one period further it would pull the tip forward
  return kBrake_N_per_m * (brake_.position_m() - p_DT_) + kBrake_N_s_per_m * (brake_.velocity_m_per_s() - v_DT_);
}

void HandControl::begin_move(Move move) noexcept {
  end_move();
  move_ = move;
}

void HandControl::end_move() noexcept {
  if (leading_) passivity_.revoke();
  leading_ = false;
  move_ = Move::kNone;
}

/// Force that pulls the tip along the planned path; zero until the gain is full.
Vec3 HandControl::lead_force() noexcept {
  if (holds_ || state_.clutch) end_move();
  if (!leading_) {
    if (!is_led() || gain() < 1.0) return Vec3::Zero();
    leading_ = path_.start(p_DT_, move_ == Move::kPark ? park_m_ : linkage_.home_m());
    if (!leading_) end_move();
    move_check_.start(state_.q_rad);
    passivity_.grant(kLeadEnergy_J);
  }
  path_.step();
  move_check_.step(from_torque_.transpose(), path_.velocity_m_per_s(), period_s_);
  const Vec3 off_m = path_.position_m() - p_DT_;
  Vec3 force_N = saturate(kBrake_N_per_m * off_m + kBrake_N_s_per_m * (path_.velocity_m_per_s() - v_DT_), kLead_N).f_N;
  if (off_m.norm() > kStray_m) {
    move_fault_ = move_check_.judge(state_.q_rad, count_rad_);
    end_move();
    return Vec3::Zero();
  }
  if (path_.is_done()) {
    if (move_ == Move::kCalibrate) map_.origin_W_m = scene_origin_W_m_;  // removes the offsets that the clutch has left
    end_move();
  }
  return force_N;
}

/// Factor by which these torques must be multiplied to make exactly the peak force in the worst pose; needs no encoder.
double HandControl::safe_share(const Vec3& torque_Nm) const noexcept {
  const double most_N = any_pose_.most_N(torque_Nm);
  return most_N > 0.0 ? limiter_.peak_N() / most_N : std::numeric_limits<double>::infinity();
}

/// Factor, at most 1, on a tip force and its torques, that keeps three limits: the peak force in the measured pose, the
/// peak force in any pose of the workspace box, and the heat of the windings. The first one is not redundant: the
/// measured pose may be outside the box.
double HandControl::allowed_share(const Vec3& f_N, const Vec3& torque_Nm) const noexcept {
  const double size_N = std::max(f_N.norm(), 1e-300);
  return std::min({1.0, limiter_.peak_N() / size_N, safe_share(torque_Nm), windings_.share(torque_Nm)});
}

/// Torques to send: J^T f, limited to the drives' range, to what is safe in any pose and to what the windings allow, in
/// whole torque quanta. A joint keeps its last torque if the change is below kStay quanta: rapid toggling is audible,
/// and the energy account cannot see its work, which may be below the encoders' resolution.
Vec3 HandControl::sendable_torque(const Vec3& f_N) const noexcept {
  constexpr double kStay = 0.7;
  Vec3 exact = (jacobian_.transpose() * f_N).cwiseMax(-max_torque_Nm_).cwiseMin(max_torque_Nm_);
  exact *= allowed_share(f_N, exact);
  Vec3 torque_Nm;
  for (Eigen::Index j = 0; j < 3; ++j) {
    const bool stays = std::abs(exact[j] - torque_Nm_[j]) < kStay * quantum_Nm_;
    torque_Nm[j] = stays ? torque_Nm_[j] : quantum_Nm_ * std::round(exact[j] / quantum_Nm_);
  }
  return torque_Nm;
}

void HandControl::fill_state(std::int16_t limits) noexcept {
  state_.gain = gain();
  state_.limits = limits;
  state_.limited = (limits & (rt::kPeakLimit | rt::kContinuousLimit | rt::kTorqueLimit)) != 0 && gain() >= 1.0;
  state_.heat = std::max(limiter_.heat(), windings_.heat());
  state_.port_energy_J = passivity_.energy_J();
  state_.received_J = passivity_.received_J();
  state_.dissipated_J = passivity_.dissipated_J();
  state_.injected_N_s_per_m = passivity_.injected_N_s_per_m();
}

}  // namespace ligature::control
