#include "host/lab/rig/port_bound.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "firmware/control/passivity.hpp"

namespace ligature::lab {

using control::Passivity;

PortBound::PortBound(const device::Device& device, std::size_t hand)
    : hand_(hand),
      reach_m_(device.hand_acceleration_m_per_s2 * 1e-6),  // in a period of 1 ms
      count_rad_(device.rad_per_count()),
      linkage_(device) {}

void PortBound::look(const sim::HandDevice& device, const rt::TickRecord& record, double received_J) {
  if (record.tick != static_cast<std::int64_t>(periods_.size()))
    throw std::logic_error("PortBound: a period was left out");
  const sim::Mechanics& arm = device.mechanics();
  const sim::Vec3 q_rad = arm.plant().q_rad(), p_m = linkage_.tip_D_m(q_rad);
  const sim::Mat3 jacobian = linkage_.jacobian_D(q_rad);
  Period now;
  now.made_Nm = arm.made_Nm();
  now.tip_N_per_Nm = jacobian.transpose().inverse();
  now.f_N = now.tip_N_per_Nm * now.made_Nm;
  now.moved_m = periods_.empty() ? sim::Vec3(sim::Vec3::Zero()) : sim::Vec3(p_m - p_m_);
  now.given_J = arm.motor_work_J() - given_J_;
  now.account_J = record.port_energy_J[hand_];
  now.reserved_count_m = count_rad_ * jacobian.colwise().norm().maxCoeff();
  now.sample = std::max<std::int64_t>(0, record.tick - record.tpdo_age_ticks[hand_]);
  const auto& permille = record.torque_permille[hand_];
  now.decides = received_J < received_J_ || std::ranges::any_of(permille, [](auto t) { return t != 0; });
  now.heard = true;
  for (std::size_t j = 0; j < 3; ++j)
    now.heard = now.heard && std::lround(now.made_Nm[static_cast<Eigen::Index>(j)] / arm.body().drives.torque_Nm(1)) ==
                                 sent_permille_[j];
  book(periods_.empty() ? Period{} : periods_.back(), now);
  for (std::size_t j = 0; j < 3; ++j) sent_permille_[j] = permille[j];
  p_m_ = p_m, given_J_ = arm.motor_work_J(), received_J_ = received_J;
  check(-given_J_ + received_J);
}

/// Adds a period, and what its sample and its torques add to the terms "hidden" and "unseen".
void PortBound::book(const Period& before, const Period& now) {
  hidden_J_ += count_rad_ * (now.made_Nm - before.made_Nm).lpNorm<1>();
  if (now.sample > before.sample) unseen_J_ += unseen_J(before.sample, now.sample);
  periods_.push_back(now);
}

void PortBound::check(double work_J) {
  const auto n = static_cast<std::int64_t>(periods_.size());
  std::int64_t m = n - 1;
  while (m >= 0 && m >= n - control::SentTorques::kMemory && !at(m).decides) --m;
  if (m < 0 || !at(m).decides) return;
  double more_J = Passivity::kFloor_J, account_J = at(m).account_J, beyond = 0.0;
  const sim::Mat3& tip_N_per_Nm = at(std::max<std::int64_t>(0, at(m).sample - 1)).tip_N_per_Nm;  // at the sample
  for (std::int64_t p = at(m).sample; p < n; ++p) {
    const Period& now = at(p);
    more_J += std::max(0.0, count_rad_ * now.made_Nm.lpNorm<1>() - now.reserved_count_m * now.f_N.norm());
    more_J += std::abs(now.given_J - (tip_N_per_Nm * now.made_Nm).dot(now.moved_m));  // by the arm's motion
    beyond += beyond_J(m, p);
    account_J -= now.given_J;
  }
  const double bound_J = more_J + beyond + hidden_J_ + count_rad_ * at(n - 1).made_Nm.lpNorm<1>() + unseen_J_;
  least_margin_J_ = std::min({least_margin_J_, account_J + more_J + beyond, work_J + bound_J});
  if (work_J < lowest_work_J_) lowest_work_J_ = work_J, its_bound_J_ = -bound_J;
  most_beyond_J_ = std::max(most_beyond_J_, beyond);
}

/// Largest change of the tip's motion from one period to the next, and at least that of the acceleration bound.
double PortBound::hasty_m(std::int64_t from, std::int64_t to) const {
  double most_m = reach_m_;
  for (std::int64_t p = std::max<std::int64_t>(1, from); p < to; ++p)
    most_m = std::max(most_m, (at(p).moved_m - at(p - 1).moved_m).norm());
  return most_m;
}

double PortBound::unseen_J(std::int64_t from, std::int64_t to) const {
  const auto end = std::min<std::int64_t>(to, static_cast<std::int64_t>(periods_.size()));
  sim::Vec3 mean_N = sim::Vec3::Zero(), before_N = sim::Vec3::Zero();
  double sum_N = 0.0;
  for (std::int64_t p = from; p < end; ++p) mean_N += at(p).f_N / static_cast<double>(end - from);
  for (std::int64_t p = from; p < end; ++p) sum_N += (before_N += at(p).f_N - mean_N).norm();
  return hasty_m(from, end) * sum_N;
}

/// Upper bound of what period p adds to the term "beyond" of the force that was sent in tick `decided`.
double PortBound::beyond_J(std::int64_t decided, std::int64_t p) const {
  const std::int64_t sample = at(decided).sample, gap = sample > 0 ? sample - at(sample - 1).sample : 1;
  const auto j = static_cast<double>(p - sample + 1);
  const double size_N = at(p).f_N.norm(), hasty = hasty_m(sample, p + 1);
  if (p >= decided && !at(p).heard)  // a joint makes another torque than was sent last
    return size_N * ((sample > 0 ? at(sample - 1).moved_m.norm() : 0.0) + j * hasty);
  const double spread = j <= 2.0 ? j : 2.0 + Passivity::kLater * (j - 2.0);
  const double doubt_m =
      j <= 2.0 ? 0.0 : reach_m_ * (spread + 0.5 * static_cast<double>(gap - 1)) + at(p).reserved_count_m;
  return size_N * std::max(0.0, j * hasty - spread * reach_m_) + std::min(size_N, Passivity::kSlight_N) * doubt_m;
}

}  // namespace ligature::lab
