#pragma once
// Jaws that close on a thread which is not quite between them: it is brought there in a moment, not at once.

#include <algorithm>

#include "firmware/physics/simulation.hpp"

namespace ligature::physics {

/// Where a tool's hold on the thread stands while its jaws close, seen from the tool: at first where the thread is and
/// as fast, at the tool after kTime_s (cubic Hermite, u = t / T):
///   c(t) = (1 - u)^2 ((1 + 2 u) c0 + u T c0'),   c(T) = c'(T) = 0
/// The coupling acts in full all the while, towards p_WT + c and v_WT + c': neither its spring nor its damper is
/// stretched when the jaws touch, so nothing is thrown and no force steps, however far off they closed. A thread that
/// cannot follow is taut by then, at no more than 1.5 K c0 / T newtons a second. O(1), no allocation.
class Closing {
 public:
  static constexpr double kTime_s = 0.05;  ///< fingers need some 100 ms to close; of 5 mm: 0.15 m/s at most

  /// @param c_m, c_m_per_s  of the thread against the tool, m and m/s
  void start(const Vec3& c_m, const Vec3& c_m_per_s) noexcept {
    from_m_ = offset_m_ = c_m;
    from_m_per_s_ = rate_m_per_s_ = c_m_per_s;
    left_s_ = kTime_s;
  }
  void forget() noexcept { *this = Closing{}; }
  /// A tick on; rate_m_per_s() is then the tick's, so that the held thread's goal moves as fast as it says.
  void step(double dt_s) noexcept {
    const Vec3 before_m = offset_m_;
    left_s_ = std::max(0.0, left_s_ - dt_s);
    const double rest = left_s_ / kTime_s, u = 1.0 - rest;
    offset_m_ = rest * rest * ((1.0 + 2.0 * u) * from_m_ + u * kTime_s * from_m_per_s_);
    rate_m_per_s_ = (offset_m_ - before_m) / dt_s;
  }

  [[nodiscard]] const Vec3& offset_m() const noexcept { return offset_m_; }
  [[nodiscard]] const Vec3& rate_m_per_s() const noexcept { return rate_m_per_s_; }
  /// What pulls at the thread.
  [[nodiscard]] ToolInput ease(ToolInput tool) const noexcept {
    tool.p_WT += offset_m_;
    tool.v_WT += rate_m_per_s_;
    return tool;
  }

 private:
  Vec3 from_m_ = Vec3::Zero(), from_m_per_s_ = Vec3::Zero(), offset_m_ = Vec3::Zero(), rate_m_per_s_ = Vec3::Zero();
  double left_s_ = 0.0;
};

}  // namespace ligature::physics
