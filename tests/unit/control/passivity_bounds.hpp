#pragma once
// Evaluates two inequalities (docs/passivity.md) during a run: how far the firmware's account of a hand's energy may be
// from the true work, and how much energy the motors may give the hand.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "firmware/control/passivity.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {

inline constexpr double kExact_J = 1e-12;  ///< rounding error of sums

/// Bounds for a hand whose tip acceleration is at most `wildness` times the device file's limit:
///   account <= work + hidden + unseen
///   work    >= -1 uJ - hidden - unseen - counted - beyond
/// Four error terms in J, all >= 0: hidden, by rounded positions in the energy that the account has booked; unseen, by
/// unknown motion between two samples; counted, by rounded positions in the energy that the account keeps in reserve
/// for a force; beyond, by lost frames that this reserve did not foresee. The last one has a ceiling that does not
/// depend on what the motors gave (ceiling_J).
class PassivityBounds {
 public:
  PassivityBounds(double count_m, double wildness)
      : count_m_(count_m), wildness_(wildness), reach_m_(plain().hand_acceleration_m_per_s2 * kT_s * kT_s) {}

  /// Of one tick: the force that was sent, the force that acted until the next SYNC, and the energy it delivered.
  struct Period {
    Vec3 sent_N, made_N;
    double given_J = 0.0;
    std::int64_t sample = 0;  ///< index of the latest encoder sample
    bool wary = false;        ///< the port expected lost frames
    Vec3 moved_m = Vec3::Zero();
    bool missed = false;  ///< a drive repeated an older torque, because its RPDO was lost
  };
  void period(const Period& now) {
    const Vec3 before_N = periods_.empty() ? Vec3(Vec3::Zero()) : periods_.back().made_N;
    hidden_J_ += count_m_ * (now.made_N - before_N).lpNorm<1>();
    periods_.push_back(now);
  }
  /// To be called when an encoder sample arrives at SYNC n, with the account after it and the true work.
  void seen(std::int64_t n, double account_J, double work_J) {
    unseen_J_ += wildness_ * reach_m_ * unseen_N(periods_.empty() ? n : periods_.back().sample, n);
    accounts_J_.resize(static_cast<std::size_t>(n + 1), accounts_J_.back());
    accounts_J_.back() = account_J;
    above_J = std::max(above_J, account_J - work_J - hidden_J() - unseen_J_);
    unseen_share = std::max(unseen_share, (account_J - work_J - hidden_J()) / std::max(unseen_J_, 1e-9));
  }
  /// To be called at every SYNC n, with or without a sample.
  void check(std::int64_t n, double work_J) {
    const std::int64_t m = last_sent(n);
    if (m < 0) return;
    const double beyond = beyond_J(m, n), more_J = beyond + counted_J(m, n);
    // The account at the sample on which tick m was based, minus the energy delivered since.
    double account_J = accounts_J_[static_cast<std::size_t>(at(m).sample)];
    for (std::int64_t p = at(m).sample; p < n; ++p) account_J -= at(p).given_J;
    below_J = std::max(below_J, -Passivity::kFloor_J - more_J - account_J);
    const double bound_J = -Passivity::kFloor_J - more_J - hidden_J() - unseen_J_;
    work_below_J = std::max(work_below_J, bound_J - work_J);
    if (work_J < lowest_work_J) lowest_work_J = work_J, its_bound_J = bound_J;
    const double ceiling = ceiling_J(m, n);
    above_ceiling_J = std::max(above_ceiling_J, beyond - ceiling);
    if (beyond > most_beyond_J) most_beyond_J = beyond, its_ceiling_J = ceiling;
  }

  double above_J = -1e9;          ///< largest excess of the account over its upper bound; positive: broken
  double below_J = -1e9;          ///< the same for the lower bound of account minus energy delivered since its sample
  double work_below_J = -1e9;     ///< the same for the work's lower bound
  double above_ceiling_J = -1e9;  ///< the same for the term "beyond" and its ceiling
  double unseen_share = 0.0;
  double lowest_work_J = 0.0, its_bound_J = -Passivity::kFloor_J;  ///< lowest true work, and its bound at that time
  double most_beyond_J = 0.0, its_ceiling_J = 0.0;                 ///< largest "beyond", and its ceiling at that time
  [[nodiscard]] double unseen_J() const { return unseen_J_; }
  /// The term "hidden": work that rounded positions hide, one count times each change of force. Half a count is due to
  /// the encoder, half to the interpolation between counts.
  [[nodiscard]] double hidden_J() const {
    return periods_.empty() ? 0.0 : hidden_J_ + count_m_ * periods_.back().made_N.lpNorm<1>();
  }

 private:
  [[nodiscard]] const Period& at(std::int64_t n) const { return periods_[static_cast<std::size_t>(n)]; }

  /// The last tick before SYNC n that sent a nonzero force; -1: none.
  [[nodiscard]] std::int64_t last_sent(std::int64_t n) const {
    for (std::int64_t m = n - 1; m >= 0 && m >= n - SentTorques::kMemory; --m)
      if (!at(m).sent_N.isZero(0.0)) return m;
    return -1;
  }

  /// The term "unseen": the tip's motion between the samples at SYNCs `from` and `to` is unknown. Given in units of a
  /// T^2 (a: acceleration bound of the hand, T: period), as the sum over all periods t between the samples of |sum over
  /// the periods after t of (force - mean force)|.
  [[nodiscard]] double unseen_N(std::int64_t from, std::int64_t to) const {
    Vec3 mean_N = Vec3::Zero(), before_N = Vec3::Zero();
    double sum_N = 0.0;
    for (std::int64_t p = from; p < to; ++p) mean_N += at(p).made_N / static_cast<double>(to - from);
    for (std::int64_t p = from; p < to; ++p) sum_N += (before_N += at(p).made_N - mean_N).norm();
    return sum_N;
  }

  /// The term "beyond": energy delivered up to SYNC n for which the account held no reserve when it chose the force of
  /// tick m.
  [[nodiscard]] double beyond_J(std::int64_t m, std::int64_t n) const {
    double sum_J = 0.0;
    for (std::int64_t p = at(m).sample; p < n; ++p) {
      const Period& now = at(p);
      if (now.made_N.isZero(0.0)) continue;
      sum_J += is_foreseen(m, p) ? wilder_J(m, p, now.made_N.norm()) : std::max(0.0, now.given_J);
    }
    return sum_J;
  }
  /// Whether the account held a reserve for the torque of period p when it chose the force of tick m.
  [[nodiscard]] bool is_foreseen(std::int64_t m, std::int64_t p) const {
    const Vec3& made_N = at(p).made_N;
    const bool as_sent = p > 0 && made_N == at(p - 1).sent_N, as_decided = made_N == at(m).sent_N;
    return at(m).wary ? p <= m || (p <= m + 2 && as_decided) : p <= m + 1 && as_sent;
  }
  /// Ceiling of the term "beyond" at SYNC n: for each period since tick m in which a drive missed its RPDO, the largest
  /// force times the largest motion; for all others, wilder_J() of the largest force. It is made of limits and of what
  /// is true at the sample, not of the energy that the motors gave.
  [[nodiscard]] double ceiling_J(std::int64_t m, std::int64_t n) const {
    const std::int64_t sample = at(m).sample;
    const double before_m = sample > 0 ? at(sample - 1).moved_m.norm() : 0.0;
    double sum_J = 0.0;
    for (std::int64_t p = sample; p < n; ++p) {
      const double moved_m = before_m + static_cast<double>(p - sample + 1) * wildness_ * reach_m_;
      const bool unforeseen = p >= m && at(p).missed;
      sum_J += std::max(unforeseen ? kMost_N * moved_m : 0.0, wilder_J(m, p, kMost_N));
    }
    return sum_J;
  }
  /// Part of the term "beyond" in period p, from the third period without a sample on: the hand may accelerate more
  /// than was assumed for the reserve of tick m, and very small forces need no reserve at all.
  [[nodiscard]] double wilder_J(std::int64_t m, std::int64_t p, double size_N) const {
    const std::int64_t sample = at(m).sample, gap = sample > 0 ? sample - at(sample - 1).sample : 1;
    const auto j = static_cast<double>(p - sample + 1);
    if (j <= 2.0) return 0.0;
    const double spread = 2.0 + Passivity::kLater * (j - 2.0);
    const double doubt_m = reach_m_ * (spread + 0.5 * static_cast<double>(gap - 1)) + count_m_;
    return size_N * reach_m_ * std::max(0.0, wildness_ * j - spread) + std::min(size_N, Passivity::kSlight_N) * doubt_m;
  }
  /// The term "counted": the last known motion is uncertain by one count per joint, but the reserve of tick m allows
  /// for one count along the force only.
  [[nodiscard]] double counted_J(std::int64_t m, std::int64_t n) const {
    double sum_N = 0.0;
    for (std::int64_t p = at(m).sample; p < n; ++p) sum_N += at(p).made_N.lpNorm<1>() - at(p).made_N.norm();
    return count_m_ * sum_N;
  }

  /// Largest tip force while torques of several ticks act together: the peak and one step.
  static inline const double kMost_N = plain().peak_force_N + plain().force_step_N;

  double count_m_, wildness_, reach_m_, hidden_J_ = 0.0, unseen_J_ = 0.0;
  std::vector<Period> periods_;
  std::vector<double> accounts_J_{0.0};  // account of the latest sample, for each SYNC
};

}  // namespace ligature::control
