#pragma once

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/thread.hpp"

namespace ligature::physics {

/// Force propagation along the thread (the paper's section IV), as limits on the segments' lengths, solved for both
/// hands at once. A taut segment with the direction e_i transmits the axial part of the hand's force f_h, (f_h . e_i)
/// e_i (equation (16)). Equation (17) as printed transmits the part ACROSS the segment, and is not used
/// (docs/physics.md).
/// Condition A: a segment strictly inside its limits (l_min, l_max) has no constraint force; only its spring acts.
/// Condition B: a segment at a limit is rigid and transmits the axial force: tension at l_max, compression at l_min.
/// Condition C: both hands hold the thread; they are two loads of one tridiagonal system
///   G M^-1 G^T lambda = violation      (G: gradients of the lengths, M: masses, lambda: constraint impulses).
/// Newton iterations on the positions, each with new directions, keep every segment within its limits for any load,
/// with a tolerance of kTolerance times its rest length.
class LengthLimits {
 public:
  static constexpr double kTolerance = 1e-7;

  LengthLimits() = default;
  LengthLimits(const ThreadModel& model, double min_length, double max_length);

  /// Call before dampers and contacts: applies the constraint forces of the last step to the velocities. So in
  /// equilibrium the velocities are zero when the dampers act, and contacts feel the transmitted force.
  void warm_start(const ThreadModel& model, ThreadState& state) noexcept;

  /// Call after positions were advanced: corrects positions and velocities. @return Newton iterations used
  int enforce(const ThreadModel& model, ThreadState& state) noexcept;

  /// Constraint force of a segment, N, in addition to its spring's force; mean over the last step, positive in tension,
  /// 0 in condition A.
  [[nodiscard]] double passed_N(int segment) const noexcept { return impulse_[segment] / step_s_; }
  void forget() noexcept;
  LIGATURE_MEMBERS(LengthLimits, rest_m, shortest_m, longest_m, step_s, segments, holding, u, length, diag, gain, link,
                   lambda, impulse, bound, start)

 private:
  /// Active limit of a segment: none, the longest or the shortest length.
  enum class Bound : signed char { kInside, kLongest, kShortest };

  [[nodiscard]] double measure(const ThreadModel& model, const ThreadState& state) noexcept;
  void remember(const ThreadModel& model, const ThreadState& state) noexcept;
  [[nodiscard]] bool is_far(const ThreadModel& model, const ThreadState& state, double outside_m) const noexcept;
  void correct(const ThreadModel& model, ThreadState& state) noexcept;
  void let_go_of_pushed(int segment) noexcept;
  void walk_outwards(const ThreadModel& model, ThreadState& state) noexcept;
  void place(const ThreadModel& model, ThreadState& state, int from, int to) noexcept;

  double rest_m_ = 0.0, shortest_m_ = 0.0, longest_m_ = 0.0, step_s_ = 1.0;
  int segments_ = 0;
  bool holding_ = false;  // some segment carries an impulse
  Lane3 u_;
  Lane length_, diag_, gain_, link_, lambda_, impulse_;
  std::vector<Bound> bound_;
  ThreadState start_;  // at the start of enforce()
};

}  // namespace ligature::physics
