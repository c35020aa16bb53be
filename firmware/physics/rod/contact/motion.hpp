#pragma once
// Upper bounds of relative speed and relative motion for every pair of segments, from one O(n) pass over the nodes.

#include <algorithm>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// Upper bounds of the relative speed of any two points of segments a < b (v_i: velocity of node i):
///   speed_a + speed_b,       with speed_j = max(|v_j|, |v_{j+1}|):         tight for strands that meet
///   drift_{b+1} - drift_a,   with drift_i = sum_{k<i} |v_{k+1} - v_k|:     tight for neighbours, which move together
/// rate() is the smaller of the two. gone() is the smaller of their time integrals since restart(), and bounds the
/// relative motion: between two moments a pair moves by at most gone(later) - gone(earlier), whichever integral is the
/// smaller one at each of them.
class Motion {
 public:
  void reserve(int nodes);

  /// Computes speed_j of every segment and drift_i of every node (class comment) from new velocities v. Keeps the
  /// previous values for outran().
  void measure(const Vec* v) noexcept;
  /// Adds a step of step_s at the velocities last measured to the integrals.
  void advance(double step_s) noexcept;
  /// Call when a new list of pairs is made. The time integrals start again at zero. The present speeds are stored,
  /// because the list's margin of distance is chosen for them.
  void restart() noexcept;

  [[nodiscard]] double rate(std::size_t a, std::size_t b) const noexcept {
    return std::min(speed_[a] + speed_[b], drift_[b + 1] - drift_[a]);
  }
  [[nodiscard]] double gone(std::size_t a, std::size_t b) const noexcept {
    return std::min(travel_[a] + travel_[b], strayed_[b + 1] - strayed_[a]);
  }
  [[nodiscard]] double fastest() const noexcept { return fastest_; }

  /// As speed(), rate() and gone(), but for any segment of block p and any segment of block q >= p. A block is kBlock
  /// neighbouring segments.
  static constexpr std::size_t kBlock = 8;
  [[nodiscard]] double speed_of_block(std::size_t p) const noexcept { return block_speed_[p]; }
  [[nodiscard]] double rate_of_blocks(std::size_t p, std::size_t q) const noexcept {
    return std::min(block_speed_[p] + block_speed_[q], drift_[end(q)] - drift_[p * kBlock]);
  }
  [[nodiscard]] double gone_of_blocks(std::size_t p, std::size_t q) const noexcept {
    return std::min(block_travel_[p] + block_travel_[q], strayed_[end(q)] - strayed_[p * kBlock]);
  }

  /// Can any pair of segments, between restart() and the time ahead_s from now, move relative to each other by more
  /// than spare_m + horizon_s x the rate() that the pair had at restart()?
  [[nodiscard]] bool used_up(double spare_m, double horizon_s, double ahead_s) const noexcept;

  /// Share of a step of dt_s at the present velocities after which used_up() is still false; rounded down to a power of
  /// 1/2, or 0.
  [[nodiscard]] double share_within(double spare_m, double horizon_s, double dt_s) const noexcept;

  /// Can the segments of any pair, within dt_s, move relative to each other by more than spare_m + 2 dt_s x the rate()
  /// that the pair had before the last measure()?
  [[nodiscard]] bool outran(double spare_m, double dt_s) const noexcept;
  LIGATURE_MEMBERS(Motion, speed, drift, speed_before, drift_before, speed_allowed, drift_allowed, travel, strayed,
                   link, block_speed, block_travel, fastest, furthest)

 private:
  [[nodiscard]] std::size_t end(std::size_t block) const noexcept {  // last node of a block
    return std::min((block + 1) * kBlock, drift_.size() - 1);
  }
  std::vector<double> speed_, drift_, speed_before_, drift_before_, speed_allowed_, drift_allowed_;
  std::vector<double> travel_, strayed_;  // time integrals of speed_ and drift_
  std::vector<double> link_;              // |v_{k+1} - v_k|
  std::vector<double> block_speed_, block_travel_;
  double fastest_ = 0.0, furthest_ = 0.0;  // largest nodal speed, and its time integral
};

}  // namespace ligature::physics::rod
