#include "sim_device/page/steered_hand.hpp"

#include <cmath>

namespace ligature::sim {
namespace {

std::array<double, 3> axes_of(const Vec3& v) noexcept { return {v.x(), v.y(), v.z()}; }
Vec3 vector_of(const std::array<double, 3>& axes) noexcept { return {axes[0], axes[1], axes[2]}; }

}  // namespace

SteeredHand::SteeredHand(const Linkage& linkage, const ArmLimits& limits) : linkage_(linkage), limits_(limits) {
  rest_.p = axes_of(linkage_.home_D_m());
}

void SteeredHand::wish(double t_s, const Vec3& p_D_m, bool dead_man, bool grip) noexcept {
  if (!std::isfinite(t_s) || !p_D_m.allFinite()) return;
  const Motion now = motion(t_s);
  if (is_silent(t_s)) must_release_ = true;
  if (!dead_man) must_release_ = false;
  dead_man_ = dead_man && !must_release_;
  grip_ = grip;
  heard_s_ = t_s;
  plan(now, within_reach(p_D_m));
}

Intent SteeredHand::at(double t_s) const noexcept {
  const Motion now = motion(t_s);
  return {vector_of(now.p), vector_of(now.v), grip_, dead_man_ && !is_silent(t_s)};
}

SteeredHand::Motion SteeredHand::motion(double t_s) const noexcept {
  if (!has_plan_) return rest_;
  Motion now;
  const double since_s = t_s - heard_s_;
  if (since_s <= kLongestSilence_s)
    towards_.at_time(since_s > 0.0 ? since_s : 0.0, now.p, now.v, now.a);
  else
    halt_.at_time(since_s - kLongestSilence_s, now.p, now.v, now.a);
  return now;
}

Vec3 SteeredHand::within_reach(const Vec3& p_D_m) const noexcept {
  constexpr int kHalvings = 20;  // bisection from a metre to a micrometre
  if (linkage_.reaches(p_D_m)) return p_D_m;
  const Vec3& home = linkage_.home_D_m();
  double good = 0.0, bad = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (good + bad);
    (linkage_.reaches(home + middle * (p_D_m - home)) ? good : bad) = middle;
  }
  return home + good * (p_D_m - home);
}

ruckig::InputParameter<3> SteeredHand::beginning(const Motion& from) const noexcept {
  ruckig::InputParameter<3> in;
  in.current_position = from.p;
  in.current_velocity = from.v;
  in.current_acceleration = from.a;
  in.max_velocity.fill(limits_.speed_m_per_s);
  in.max_acceleration.fill(limits_.acceleration_m_per_s2);
  in.max_jerk.fill(limits_.jerk_m_per_s3);
  return in;
}

/// Plans the motion to the target, and the stop that follows if no target comes within kLongestSilence_s. Both motions
/// always exist, because all motions obey the same limits. Should planning fail nevertheless, the hand stays where it
/// is.
void SteeredHand::plan(const Motion& from, const Vec3& to_D_m) noexcept {
  rest_ = {from.p, {}, {}};
  auto in = beginning(from);
  in.target_position = axes_of(to_D_m);
  has_plan_ = planner_.calculate(in, towards_) == ruckig::Result::Working;
  if (!has_plan_) return;
  Motion then;
  towards_.at_time(kLongestSilence_s, then.p, then.v, then.a);
  auto halt = beginning(then);
  halt.control_interface = ruckig::ControlInterface::Velocity;
  has_plan_ = planner_.calculate(halt, halt_) == ruckig::Result::Working;
}

}  // namespace ligature::sim
