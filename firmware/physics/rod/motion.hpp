#pragma once
// How far anything can have moved: bounds for every pair of segments at once, from one pass over the nodes.

#include <algorithm>
#include <vector>

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Two bounds of the relative motion of segments a < b, whose points lie between their end nodes:
///   speed_a + speed_b,                speed_j = max(|v_j|, |v_j+1|),        good for strands that meet;
///   drift_{b+1} - drift_a,            drift_i = sum_{k<i} |v_{k+1} - v_k|,  good for neighbours, which move together.
/// `rate` is the lesser of the two. Summed over substeps they bound what a pair has `gone` since restart(): for any two
/// instants, gone(later) - gone(earlier) is at least the distance the pair has moved relative to each other (whichever
/// of the two bounds is the lesser at either instant).
class Motion {
 public:
  void reserve(int nodes);

  /// Velocities of now. The ones before are kept for outran().
  void measure(const Vec* v) noexcept;
  /// Everything moved with the velocities last measured.
  void advance(double step_s) noexcept;
  /// Forgets what was gone, and takes today's rates as those allowed for by broad_phase margins.
  void restart() noexcept;

  [[nodiscard]] double speed(std::size_t segment) const noexcept { return speed_[segment]; }
  [[nodiscard]] double rate(std::size_t a, std::size_t b) const noexcept {
    return std::min(speed_[a] + speed_[b], drift_[b + 1] - drift_[a]);
  }
  [[nodiscard]] double gone(std::size_t a, std::size_t b) const noexcept {
    return std::min(travel_[a] + travel_[b], strayed_[b + 1] - strayed_[a]);
  }
  [[nodiscard]] double fastest() const noexcept { return fastest_; }

  /// Blocks of neighbouring segments: nothing in block p and nothing in block q >= p is faster, or has gone farther,
  /// relative to each other than this.
  static constexpr std::size_t kBlock = 8;
  [[nodiscard]] double speed_of_block(std::size_t p) const noexcept { return block_speed_[p]; }
  [[nodiscard]] double rate_of_blocks(std::size_t p, std::size_t q) const noexcept {
    return std::min(block_speed_[p] + block_speed_[q], drift_[end(q)] - drift_[p * kBlock]);
  }
  [[nodiscard]] double gone_of_blocks(std::size_t p, std::size_t q) const noexcept {
    return std::min(block_travel_[p] + block_travel_[q], strayed_[end(q)] - strayed_[p * kBlock]);
  }

  /// May some pair have gone, or go in `ahead_s`, more than spare_m + horizon_s x its rate at restart()?
  [[nodiscard]] bool used_up(double spare_m, double horizon_s, double ahead_s) const noexcept;

  /// The share of what everything would move in dt_s, at the velocities of now, after which no pair has gone more than
  /// spare_m + horizon_s x its rate at restart(). Never too large; 0 or a power of a half.
  [[nodiscard]] double share_within(double spare_m, double horizon_s, double dt_s) const noexcept;

  /// May some pair, in dt_s, move by more than spare_m + twice what its rate before the last measure() said?
  [[nodiscard]] bool outran(double spare_m, double dt_s) const noexcept;

 private:
  [[nodiscard]] std::size_t end(std::size_t block) const noexcept {  // last node of a block
    return std::min((block + 1) * kBlock, drift_.size() - 1);
  }
  std::vector<double> speed_, drift_, speed_before_, drift_before_, speed_allowed_, drift_allowed_;
  std::vector<double> travel_, strayed_;  // time integrals of speed and drift
  std::vector<double> link_;              // |v_{k+1} - v_k|
  std::vector<double> block_speed_, block_travel_;
  double fastest_ = 0.0, furthest_ = 0.0;  // speed of the fastest node now, and its time integral
};

}  // namespace ligature::physics::rod
