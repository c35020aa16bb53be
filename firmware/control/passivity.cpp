#include "firmware/control/passivity.hpp"

#include <algorithm>

namespace ligature::control {

Passivity::Passivity(const device::Device& d, double period_s, bool active, double credit_J) noexcept
    : period_s_(period_s),
      reach_m_(d.hand_acceleration_m_per_s2 * period_s * period_s),
      active_(active),
      energy_J_(credit_J) {}

const Passivity::Sent& Passivity::in_tick(std::int64_t tick) const noexcept {
  static const Sent nothing{};
  if (tick < 0 || tick > last_sent_ || tick <= last_sent_ - static_cast<std::int64_t>(kMemory)) return nothing;
  return memory_[static_cast<std::size_t>(tick) % kMemory];
}

void Passivity::observe(std::int64_t tick, const JointAngles& q_rad, const Vec3& p_m, double tip_per_count_m) noexcept {
  count_m_ = tip_per_count_m;
  if (sampled_ >= 0 && tick > sampled_) {
    const auto periods = static_cast<double>(tick - sampled_);
    const Vec3 per_period = (vector_of(q_rad) - vector_of(q_rad_)) / periods;
    step_m_ = (p_m - p_m_) / periods;
    // What acts in the period that begins with SYNC i was sent in tick i - 1.
    const std::int64_t first = std::max(sampled_, tick - static_cast<std::int64_t>(kMemory));
    for (std::int64_t i = first; i < tick; ++i) energy_J_ -= in_tick(i - 1).torque_Nm.dot(per_period);
    if (active_) energy_J_ = std::min(energy_J_, kCredit_J);
  }
  sampled_ = tick;
  q_rad_ = q_rad;
  p_m_ = p_m;
}

double Passivity::loss_J(const Vec3& f_N, std::int64_t period) const noexcept {
  const double spread_m = static_cast<double>(period) * reach_m_ + count_m_;
  return std::max(0.0, f_N.dot(step_m_) + f_N.norm() * spread_m);
}

double Passivity::room_J(std::int64_t tick) const noexcept {
  double room = energy_J_ + kFloor_J;
  for (std::int64_t i = sampled_; i <= tick; ++i) room -= loss_J(in_tick(i - 1).f_N, i - sampled_ + 1);
  return room;
}

bool Passivity::allows(std::int64_t tick, const Vec3& f_N) const noexcept {
  return !active_ || f_N.isZero(0.0) || loss_J(f_N, tick - sampled_ + 2) <= room_J(tick);
}

Vec3 Passivity::control(std::int64_t tick, const Vec3& f_N, const Vec3& v_m_per_s) noexcept {
  injected_ = 0.0;
  acts_ = false;
  if (allows(tick, f_N)) return f_N;
  acts_ = true;
  const double room = room_J(tick);
  const std::int64_t period = tick - sampled_ + 2;
  Vec3 f = f_N;
  const double speed = v_m_per_s.norm();
  if (f_N.dot(v_m_per_s) > 0.0 && speed > kSlow_m_per_s) {  // the rig is giving: brake the motion
    const double shortage = loss_J(f_N, period) - std::max(0.0, room);
    injected_ = std::min(kMaxDamping_N_s_per_m, shortage / (period_s_ * speed * speed));
    f -= injected_ * v_m_per_s;
    dissipated_J_ += injected_ * speed * speed * period_s_;
  }
  const double loss = loss_J(f, period);
  if (loss <= room) return f;
  return room > 0.0 ? Vec3(f * (room / loss)) : Vec3(Vec3::Zero());
}

void Passivity::sent(std::int64_t tick, const Vec3& torque_Nm, const Vec3& f_N) noexcept {
  const Sent now{torque_Nm, f_N};
  const Sent held = in_tick(last_sent_);  // a lost period sends nothing: the drives hold what they have
  const std::int64_t from = std::max(last_sent_ + 1, tick - static_cast<std::int64_t>(kMemory));
  for (std::int64_t i = from; i < tick; ++i) memory_[static_cast<std::size_t>(i) % kMemory] = held;
  memory_[static_cast<std::size_t>(tick) % kMemory] = now;
  last_sent_ = tick;
}

void Passivity::share(Passivity& a, Passivity& b) noexcept {
  if (!a.active_ || !b.active_) return;
  a.energy_J_ = b.energy_J_ = 0.5 * (a.energy_J_ + b.energy_J_);
}

}  // namespace ligature::control
