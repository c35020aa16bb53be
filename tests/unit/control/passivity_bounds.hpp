#pragma once
// The bounds of docs/passivity.md, summed beside a run: what a port's account and the motors' true work may be.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "firmware/control/passivity.hpp"
#include "tests/unit/control/plain_device.hpp"

namespace ligature::control {

/// For a hand that gives the tip at most a share `wildness` of the record's acceleration; all terms >= 0:
///   account <= work + hidden + unseen
///   work    >= -1 uJ - hidden - unseen - counted - beyond
class PassivityBounds {
 public:
  PassivityBounds(double count_m, double wildness)
      : count_m_(count_m), wildness_(wildness), reach_m_(plain().hand_acceleration_m_per_s2 * kT_s * kT_s) {}

  /// What was decided in a tick, and what the motors made from its SYNC to the next one's.
  struct Period {
    Vec3 sent_N, made_N;
    double given_J = 0.0;
    std::int64_t sample = 0;  ///< the last one then
    bool wary = false;        ///< lost frames were foreseen
  };
  void period(const Period& now) {
    const Vec3 before_N = periods_.empty() ? Vec3(Vec3::Zero()) : periods_.back().made_N;
    hidden_J_ += count_m_ * (now.made_N - before_N).lpNorm<1>();
    periods_.push_back(now);
  }
  /// A sample was taken at SYNC n.
  void seen(std::int64_t n, double account_J, double work_J) {
    unseen_J_ += wildness_ * reach_m_ * unseen_N(periods_.empty() ? n : periods_.back().sample, n);
    accounts_J_.resize(static_cast<std::size_t>(n + 1), accounts_J_.back());
    accounts_J_.back() = account_J;
    above_J = std::max(above_J, account_J - work_J - hidden_J() - unseen_J_);
    unseen_share = std::max(unseen_share, (account_J - work_J - hidden_J()) / std::max(unseen_J_, 1e-9));
  }
  /// At SYNC n, seen or not.
  void check(std::int64_t n, double work_J) {
    const std::int64_t m = last_sent(n);
    if (m < 0) return;
    const double more_J = beyond_J(m, n) + counted_J(m, n);
    double account_J = accounts_J_[static_cast<std::size_t>(at(m).sample)];  // less what was given since
    for (std::int64_t p = at(m).sample; p < n; ++p) account_J -= at(p).given_J;
    below_J = std::max(below_J, -Passivity::kFloor_J - more_J - account_J);
    work_below_J = std::max(work_below_J, -Passivity::kFloor_J - more_J - hidden_J() - unseen_J_ - work_J);
    most_beyond_J = std::max(most_beyond_J, more_J);
  }

  double above_J = -1e9;       ///< the account over its bound; positive: broken
  double below_J = -1e9;       ///< the same of the account, less what was given since its sample, under its floor
  double work_below_J = -1e9;  ///< the same of the work
  double unseen_share = 0.0, most_beyond_J = 0.0;
  [[nodiscard]] double unseen_J() const { return unseen_J_; }
  /// Half a count by the encoder and half by the guess, at each change of torque.
  [[nodiscard]] double hidden_J() const {
    return periods_.empty() ? 0.0 : hidden_J_ + count_m_ * periods_.back().made_N.lpNorm<1>();
  }

 private:
  [[nodiscard]] const Period& at(std::int64_t n) const { return periods_[static_cast<std::size_t>(n)]; }

  /// The last tick before SYNC n whose decision was a force.
  [[nodiscard]] std::int64_t last_sent(std::int64_t n) const {
    for (std::int64_t m = n - 1; m >= 0 && m >= n - SentTorques::kMemory; --m)
      if (!at(m).sent_N.isZero(0.0)) return m;
    return -1;
  }

  /// Nobody saw when, between two samples, the tip moved: sum over t of |sum over later periods of force less its
  /// mean|.
  [[nodiscard]] double unseen_N(std::int64_t from, std::int64_t to) const {
    Vec3 mean_N = Vec3::Zero(), before_N = Vec3::Zero();
    double sum_N = 0.0;
    for (std::int64_t p = from; p < to; ++p) mean_N += at(p).made_N / static_cast<double>(to - from);
    for (std::int64_t p = from; p < to; ++p) sum_N += (before_N += at(p).made_N - mean_N).norm();
    return sum_N;
  }

  /// Given from the sample of decision m on, up to SYNC n, and not foreseen by that decision.
  [[nodiscard]] double beyond_J(std::int64_t m, std::int64_t n) const {
    double sum_J = 0.0;
    for (std::int64_t p = at(m).sample; p < n; ++p) {
      const Period& now = at(p);
      if (now.made_N.isZero(0.0)) continue;
      const bool as_sent = p > 0 && now.made_N == at(p - 1).sent_N, as_decided = now.made_N == at(m).sent_N;
      const bool foreseen = at(m).wary ? p <= m || (p <= m + 2 && as_decided) : p <= m + 1 && as_sent;
      sum_J += foreseen ? wilder_J(m, p) : std::max(0.0, now.given_J);
    }
    return sum_J;
  }
  /// From the third period after a sample on: a hand that is wilder than foreseen, and a force too slight to be.
  [[nodiscard]] double wilder_J(std::int64_t m, std::int64_t p) const {
    const std::int64_t sample = at(m).sample, gap = sample > 0 ? sample - at(sample - 1).sample : 1;
    const auto j = static_cast<double>(p - sample + 1);
    if (j <= 2.0) return 0.0;
    const double spread = 2.0 + Passivity::kLater * (j - 2.0), size_N = at(p).made_N.norm();
    const double doubt_m = reach_m_ * (spread + 0.5 * static_cast<double>(gap - 1)) + count_m_;
    return size_N * reach_m_ * std::max(0.0, wildness_ * j - spread) + std::min(size_N, Passivity::kSlight_N) * doubt_m;
  }
  /// A count a joint, of the last motion; foreseen is one along the force.
  [[nodiscard]] double counted_J(std::int64_t m, std::int64_t n) const {
    double sum_N = 0.0;
    for (std::int64_t p = at(m).sample; p < n; ++p) sum_N += at(p).made_N.lpNorm<1>() - at(p).made_N.norm();
    return count_m_ * sum_N;
  }

  double count_m_, wildness_, reach_m_, hidden_J_ = 0.0, unseen_J_ = 0.0;
  std::vector<Period> periods_;
  std::vector<double> accounts_J_{0.0};  // at each SYNC: at the last sample
};

}  // namespace ligature::control
