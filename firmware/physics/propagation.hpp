#pragma once

#include "firmware/physics/thread.hpp"

namespace ligature::physics {

/// Force propagation along the thread, paper section IV, as one solve for both hands. What a taut segment passes is the
/// axial part of the force, equation (16): (f_h . e_i) e_i. Equation (17) as printed passes the part ACROSS the segment
/// and is not used (docs/physics.md).
///   Condition A: a segment strictly inside (l_min, l_max) passes nothing; its spring carries what it can.
///   Condition B: a segment on its limit is rigid, so the axial force passes through: tension at l_max, push at l_min.
///   Condition C: two hands are two loads of one tridiagonal system G M^-1 G^T lambda = violation, not two passes.
/// Lengths are held by Newton on the positions (the system is solved anew with the new directions), so that no segment
/// is outside its limits by more than kTolerance of rest length after a step, whatever pulls.
class LengthLimits {
 public:
  static constexpr double kTolerance = 1e-7;

  LengthLimits() = default;
  LengthLimits(const ThreadModel& model, double min_length, double max_length);

  /// Velocity level, before dampers and contacts: applies last step's tensions again. So dampers see no speed in a
  /// balance, and contacts feel the pull that passes through.
  void warm_start(const ThreadModel& model, ThreadState& state) noexcept;

  /// Position level, after positions moved: corrects them and the velocities. @return Newton iterations used
  int enforce(const ThreadModel& model, ThreadState& state) noexcept;

  /// Force that segment i passed on beside its spring, N (mean of the last step), positive in tension; 0 in condition
  /// A.
  [[nodiscard]] double passed_N(int segment) const noexcept { return impulse_[segment] / step_s_; }
  void forget() noexcept;

 private:
  /// Where a segment is: inside its limits, held at the longest or at the shortest length, or let go in this step.
  enum class Bound : signed char { kInside, kLongest, kShortest };

  [[nodiscard]] bool measure(const ThreadModel& model, const ThreadState& state) noexcept;
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
};

}  // namespace ligature::physics
