#include "firmware/control/passivity.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::control {

const Passivity::Sent Passivity::kNothing{};

Passivity::Passivity(const device::Device& d, double period_s, bool active, double credit_J) noexcept
    : period_s_(period_s),
      reach_m_(d.hand_acceleration_m_per_s2 * period_s * period_s),
      step_N_(d.force_step_N),
      active_(active),
      energy_J_(credit_J) {}

const Passivity::Sent& Passivity::in_tick(std::int64_t tick) const noexcept {
  if (tick < 0 || tick > last_sent_ || tick <= last_sent_ - static_cast<std::int64_t>(kMemory)) return kNothing;
  return memory_[static_cast<std::size_t>(tick) % kMemory];
}

void Passivity::observe(std::int64_t tick, const PortSample& s) noexcept {
  count_m_ = s.count_rad * s.lever_m.maxCoeff();
  if (sampled_ >= 0 && tick > sampled_) {
    const auto periods = static_cast<double>(tick - sampled_);
    const Vec3 dq_rad = (vector_of(s.q_rad) - vector_of(q_rad_)) / periods;
    step_m_ = (s.p_m - p_m_) / periods;
    const std::int64_t first = std::max(sampled_, tick - static_cast<std::int64_t>(kMemory));
    for (std::int64_t i = first; i < tick - 1; ++i) {
      book(i, dq_rad, {});  // nobody saw how the motion was shared out among these periods
      energy_J_ -= 0.5 * (periods - 1.0) * reach_m_ * (in_tick(i - 1).f_N - in_tick(tick - 2).f_N).norm();
    }
    book(tick - 1, dq_rad, s.acted);
    if (active_) energy_J_ = std::min(energy_J_, kCredit_J + granted_J_);
  }
  sampled_ = tick;
  q_rad_ = s.q_rad;
  p_m_ = s.p_m;
}

/// The period that begins with SYNC `period`: what acts in it was sent in the tick before.
void Passivity::book(std::int64_t period, const Vec3& dq_rad, const Acted& acted) noexcept {
  Vec3 made_Nm = in_tick(period - 1).torque_Nm;
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto joint = static_cast<std::size_t>(j);
    double out_J = made_Nm[j] * dq_rad[j];
    const bool told = std::isfinite(acted.torque_Nm[j]);
    if (told || acted.held[joint] > 0)
      made_Nm[j] = told ? acted.torque_Nm[j] : in_tick(period - 1 - acted.held[joint]).torque_Nm[j];
    out_J = std::max(out_J, made_Nm[j] * dq_rad[j]);
    if (acted.limited[joint] && !told) out_J = std::max(out_J, 0.0);
    energy_J_ -= out_J;
  }
}

double Passivity::loss_J(const Vec3& f_N, double spread_m) const noexcept {
  return std::max(0.0, f_N.dot(step_m_) + f_N.norm() * spread_m);
}

/// What is missing to send f in `tick` and to take it back in steps; below zero: what is left.
double Passivity::shortage_J(std::int64_t tick, const Vec3& f_N) const noexcept {
  double spent_J = 0.0;
  const auto spend = [&](const Vec3& f, std::int64_t period, double counts) {
    spent_J += loss_J(f, static_cast<double>(period) * reach_m_ + counts * count_m_);
  };
  const auto remembered = last_sent_ - static_cast<std::int64_t>(kMemory) + 2;  // without samples the way is no longer
  for (std::int64_t i = std::max(sampled_, remembered); i <= tick; ++i) {       // under way
    spend(in_tick(i - 1).f_N, i - sampled_ + 1, 1.0);
  }
  spend(f_N, tick - sampled_ + 2, 1.0);
  Vec3 f = shorter(f_N, step_N_);
  for (std::int64_t k = 1; !f.isZero(0.0); ++k) {  // each step back sees one more count
    spend(f, tick - sampled_ + 2 + k, 1.0 + static_cast<double>(k));
    f = shorter(f, step_N_);
  }
  return spent_J - energy_J_ - kSpend_J;
}

/// Against the motion, as far as one step goes.
Vec3 Passivity::damped(std::int64_t tick, const Vec3& wish_N, const Vec3& v, const Vec3& before_N) noexcept {
  const double speed = v.norm();
  if (wish_N.dot(v) <= 0.0 || speed <= kSlow_m_per_s) return wish_N;  // the rig does not give
  injected_ = std::min(kMaxDamping_N_s_per_m, shortage_J(tick, wish_N) / (period_s_ * speed * speed));
  dissipated_J_ += injected_ * speed * speed * period_s_;
  const Vec3 change_N = wish_N - injected_ * v - before_N;
  const Vec3 f_N = before_N + change_N * std::min(1.0, step_N_ / std::max(change_N.norm(), step_N_));
  const double most_N = std::max(wish_N.norm(), before_N.norm()), size_N = f_N.norm();
  return size_N > most_N ? Vec3(f_N * (most_N / size_N)) : f_N;  // braking is no reason to exceed a limit
}

void Passivity::sent(std::int64_t tick, const Vec3& torque_Nm, const Vec3& f_N) noexcept {
  const Sent now{torque_Nm, f_N};
  const Sent held = in_tick(last_sent_);  // a lost period sends nothing: the drives hold what they have
  const std::int64_t from = std::max(last_sent_ + 1, tick - static_cast<std::int64_t>(kMemory));
  for (std::int64_t i = from; i < tick; ++i) memory_[static_cast<std::size_t>(i) % kMemory] = held;
  memory_[static_cast<std::size_t>(tick) % kMemory] = now;
  last_sent_ = tick;
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
  if ((short_a_J > 0.0) == (short_b_J > 0.0)) return;  // nobody is short, or nobody can spare
  const double lack_J = std::max(short_a_J, short_b_J) + kRounding_J,
               spare_J = -0.999999 * std::min(short_a_J, short_b_J);
  const double size_J = std::min(lack_J, spare_J), to_a_J = short_a_J > 0.0 ? size_J : -size_J;
  a.energy_J_ += to_a_J;
  a.received_J_ += to_a_J;
  b.energy_J_ -= to_a_J;
  b.received_J_ -= to_a_J;
}

}  // namespace ligature::control
