#include "firmware/control/passivity.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ligature::control {

Passivity::Passivity(const device::Device& d, double period_s, bool active, double credit_J) noexcept
    : period_s_(period_s),
      reach_m_(d.hand_acceleration_m_per_s2 * period_s * period_s),
      step_N_(d.force_step_N),
      any_pose_(d),
      active_(active),
      credit_J_(credit_J),
      energy_J_(credit_J) {}

void Passivity::observe(std::int64_t tick, const PortSample& s) noexcept {
  sent_.begin(tick);
  const auto periods = static_cast<double>(tick - sampled_);
  const double half_rad = 0.5 * s.count_rad;
  const Vec3 counted_rad = vector_of(s.q_rad);
  Vec3 q_rad = counted_rad;
  if (sampled_ >= 0 && tick > sampled_) {
    if (tick > sampled_ + 1) lossy_until_ = tick + kWary;
    for (Eigen::Index j = 0; j < 3; ++j) {
      // Estimates a slow joint's position between two encoder counts from its velocity. For fast joints the velocity
      // estimate lags too much.
      const double turned_rad = periods * period_s_ * s.rate_rad_per_s[j];
      if (std::abs(turned_rad) < kSlowCounts * periods * s.count_rad)
        q_rad[j] = std::clamp(q_rad_[j] + turned_rad, counted_rad[j] - half_rad, counted_rad[j] + half_rad);
    }
    for (Eigen::Index j = 0; j < 3; ++j) energy_J_ -= most_given_J(j, tick, q_rad[j] - q_rad_[j], s);
    if (active_) energy_J_ = std::min(energy_J_, kCredit_J + granted_J_);
    step_m_ = (s.p_m - p_m_) / periods;
    doubt_m_ = 0.5 * (periods - 1.0) * reach_m_;
    count_m_ = s.count_rad * s.lever_m.maxCoeff() / periods;
  }
  sampled_ = tick;
  q_rad_ = q_rad;
  p_m_ = s.p_m;
  tip_N_per_Nm_ = s.tip_N_per_Nm;
  Nm_per_tip_N_ = tip_N_per_Nm_.inverse();
  look_under_way(tick);
}

/// Computes the range of the torques that may act until the next SYNC (under_way_), and the largest energy that these
/// torques can give to the hand (under_way_J_). After lost RPDOs, each joint may make any torque sent since the last
/// sample.
void Passivity::look_under_way(std::int64_t tick) noexcept {
  const bool wary = is_wary(tick);
  under_way_ = {low_Nm_, high_Nm_};
  under_way_J_ = 0.0;
  for (std::int64_t i = sent_.cycle_of(sampled_); i <= sent_.newest(); ++i) {
    const SentTorques::Cycle& before = sent_.at(i - 1);
    under_way_.take(before.torque_Nm);
    const std::int64_t start = std::max<std::int64_t>(0, sent_.at(i).tick - sampled_), periods = sent_.periods(i);
    const auto loss = [&](const Vec3& f_N) { return blind_loss_J(f_N, start, periods); };
    under_way_J_ += wary ? under_way_.worst(tip_N_per_Nm_, loss) : loss(before.f_N);
  }
  under_way_N_ = under_way_.worst(tip_N_per_Nm_, [](const Vec3& f_N) { return f_N.norm(); });
}

bool Passivity::is_a_step(const Vec3& torque_Nm) const noexcept {
  if (torque_Nm == sent_.at(sent_.newest() - 1).torque_Nm) return true;
  const Box change{(torque_Nm - under_way_.high_Nm).cwiseMin(0.0), (torque_Nm - under_way_.low_Nm).cwiseMax(0.0)};
  constexpr double kMargin = 0.98;  // margin for the arm's motion until the torque acts
  return any_pose_.most_N(change.low_Nm, change.high_Nm) <= kAnyPose * step_N_ &&
         change.worst(tip_N_per_Nm_, [](const Vec3& f_N) { return f_N.norm(); }) <= kMargin * step_N_;
}

/// Largest force change in this direction that counts as one step.
double Passivity::step_along_N(const Vec3& along) const noexcept {
  const double any_pose_N = any_pose_.most_N(Nm_per_tip_N_ * along);
  return any_pose_N > kAnyPose ? step_N_ * kAnyPose / any_pose_N : step_N_;
}

/// Upper bound of the energy that one joint's motor gave since the last sample. The torque is known in the last cycle,
/// and in the cycles before it in which the drive received nothing new. In all other cycles the drive made any torque
/// sent since the last sample, or the torque from before that sample.
double Passivity::most_given_J(Eigen::Index j, std::int64_t tick, double dq_rad, const PortSample& s) noexcept {
  const auto joint = static_cast<std::size_t>(j);
  const std::int64_t first = sent_.cycle_of(sampled_), last = std::max(first, sent_.cycle_of(tick - 1));
  const auto asked_Nm = [&](std::int64_t i) { return sent_.at(i - 1).torque_Nm[j]; };
  const bool told = std::isfinite(s.acted.torque_Nm[j]);
  const double made_Nm = told ? s.acted.torque_Nm[j] : asked_Nm(last - s.acted.held[joint]);
  const bool guarded = s.acted.limited[joint] || guarded_[joint];
  if (!guarded && made_Nm != asked_Nm(last)) lossy_until_ = tick + kWary;
  std::int64_t known = last + (guarded ? 1 : 0);  // the joint made made_Nm from this cycle on
  while (!guarded && known > first && (told ? made_Nm != asked_Nm(known) : last - known < s.acted.held[joint])) --known;

  const double all = static_cast<double>(tick - sampled_);
  double given_J = made_Nm * dq_rad;
  double low_Nm = low_Nm_[j], high_Nm = high_Nm_[j];
  const auto widen = [&](double by_Nm) { low_Nm = std::min(low_Nm, by_Nm), high_Nm = std::max(high_Nm, by_Nm); };
  if (guarded) widen(told ? made_Nm : 0.0);
  for (std::int64_t i = first; i < known; ++i) {
    widen(asked_Nm(i));
    const double even_rad = dq_rad * static_cast<double>(sent_.periods(i)) / all;
    given_J += std::max((high_Nm - made_Nm) * even_rad, (low_Nm - made_Nm) * even_rad);
  }
  low_Nm_[j] = guarded ? low_Nm : made_Nm;
  high_Nm_[j] = guarded ? high_Nm : made_Nm;
  guarded_[joint] = s.acted.limited[joint];
  return given_J;
}

/// Largest loss, that is energy which the motors give to the hand, by the tip force f_N. The force acts for `periods`
/// periods and begins `start` periods after the sample's SYNC. `counts`: how many encoder counts each period's motion
/// is uncertain by.
double Passivity::loss_J(const Vec3& f_N, std::int64_t start, std::int64_t periods, double counts) const noexcept {
  const auto s = static_cast<double>(start), d = static_cast<double>(periods);
  const double spread_m = reach_m_ * (d * s + 0.5 * d * (d + 1.0)) + d * (doubt_m_ + counts * count_m_);
  return std::max(0.0, d * along_J(f_N) + f_N.norm() * spread_m);
}

/// As loss_J(), for the time in which frames are lost. From the third period after the sample on, the hand accelerates
/// at most by kLater times the bound, and the uncertainty of its motion counts only for the part of the force above
/// kSlight_N.
double Passivity::blind_loss_J(const Vec3& f_N, std::int64_t start, std::int64_t periods) const noexcept {
  double lost_J = 0.0;
  const double size_N = std::max(0.0, f_N.norm() - kSlight_N);
  for (std::int64_t j = start + 1; j <= start + std::min(periods, SentTorques::kMemory); ++j) {
    const double spread_m = reach_m_ * (2.0 + kLater * static_cast<double>(j - 2)) + doubt_m_ + count_m_;
    lost_J += j <= 2 ? loss_J(f_N, j - 1, 1, 1.0) : std::max(0.0, along_J(f_N) + size_N * spread_m);
  }
  return lost_J;
}

/// Energy that the tip force f_N gives to the hand in a period in which the hand moves as in the last one. If this
/// energy is negative (the hand gives energy), it is computed with one encoder count less of motion, because the real
/// motion may be that much smaller.
double Passivity::along_J(const Vec3& f_N) const noexcept {
  const double given_J = f_N.dot(step_m_);
  return given_J > 0.0 ? given_J : std::min(0.0, given_J + f_N.norm() * count_m_);
}

/// Energy that the account lacks for sending the force f_N in `tick` and, with `and_back`, for reducing the force to
/// zero later; negative: energy to spare. Each force must be within one step of both forces sent before it, because a
/// lost frame leaves either of them acting. So a reduction by one step takes two periods.
double Passivity::shortage_J(std::int64_t tick, const Vec3& f_N, bool and_back) const noexcept {
  const bool blind = tick > sampled_, wary = is_wary(tick);
  const std::int64_t ahead = tick + 1 - sampled_;
  double size_N = f_N.norm(), told_N = under_way_N_;
  const Vec3 along = f_N / std::max(size_N, 1e-300);
  double spent_J = under_way_J_ + blind_loss_J(f_N, ahead, wary ? 2 : 1);
  if (wary) spent_J += kMore * std::max(0.0, along_J(f_N));
  const double step_N = and_back ? step_along_N(along) : step_N_;
  for (std::int64_t k = 1; and_back; ++k) {
    const double next_N = std::clamp(std::max(told_N, size_N) - step_N, 0.0, size_N);
    told_N = size_N, size_N = next_N;
    if (size_N == 0.0) break;
    const Vec3 f = along * size_N;  // each further period adds half a count of uncertainty
    spent_J += blind ? blind_loss_J(f, ahead + k, 1) : loss_J(f, ahead + k, 1, 1.0 + 0.5 * static_cast<double>(k));
  }
  return spent_J - energy_J_ - kSpend_J;
}

/// Adds damping against the motion, limited to one step.
Vec3 Passivity::damped(std::int64_t tick, const Vec3& wish_N, const Vec3& v, const Vec3& before_N) noexcept {
  const double speed = v.norm();
  // The force takes energy from the hand: no damping needed
  if (wish_N.dot(v) <= 0.0 || speed <= kSlow_m_per_s) return wish_N;
  injected_ = std::min(kMaxDamping_N_s_per_m, shortage_J(tick, wish_N) / (period_s_ * speed * speed));
  dissipated_J_ += injected_ * speed * speed * period_s_;
  const Vec3 change_N = wish_N - injected_ * v - before_N;
  const Vec3 f_N = before_N + change_N * std::min(1.0, step_N_ / std::max(change_N.norm(), step_N_));
  const double most_N = std::max(wish_N.norm(), before_N.norm()), size_N = f_N.norm();
  return size_N > most_N ? Vec3(f_N * (most_N / size_N)) : f_N;  // damping must not exceed the larger of the two forces
}

void Passivity::sent(std::int64_t tick, const Vec3& torque_Nm, const Vec3& f_N) noexcept {
  sent_.begin(tick);
  sent_.send(torque_Nm, f_N);
}

void Passivity::grant(double energy_J) noexcept {
  revoke();
  granted_J_ = energy_J;
  energy_J_ += energy_J;
  received_J_ += energy_J;
}

void Passivity::revoke() noexcept {
  const double left_J = std::min(granted_J_, std::max(0.0, energy_J_));
  energy_J_ -= left_J;
  received_J_ -= left_J;
  granted_J_ = 0.0;
}

void Passivity::lend(std::int64_t tick, Passivity& a, const Vec3& wish_a_N, Passivity& b,
                     const Vec3& wish_b_N) noexcept {
  if (!a.active_ || !b.active_) return;
  const double short_a_J = a.shortage_J(tick, wish_a_N), short_b_J = b.shortage_J(tick, wish_b_N);
  if ((short_a_J > 0.0) == (short_b_J > 0.0)) return;  // neither is short, or both are
  const double lack_J = std::max(short_a_J, short_b_J) + kRounding_J,
               spare_J = -0.999999 * std::min(short_a_J, short_b_J);
  const double size_J = std::min(lack_J, spare_J), to_a_J = short_a_J > 0.0 ? size_J : -size_J;
  a.energy_J_ += to_a_J;
  a.received_J_ += to_a_J;
  b.energy_J_ -= to_a_J;
  b.received_J_ -= to_a_J;
}

}  // namespace ligature::control
