#pragma once
// Smooth closing of a gripper's jaws on a thread that is not exactly between them: the thread is brought there within
// kTime_s.

#include <algorithm>

#include "firmware/physics/members.hpp"
#include "firmware/physics/simulation.hpp"

namespace ligature::physics {

/// While the jaws close, the coupling pulls the thread towards a moving point at the offset c(t) from the tool. c(t)
/// starts with the thread's position c0 and velocity c0' relative to the tool, and is zero after the time T = kTime_s
/// (cubic Hermite curve, u = t / T):
///   c(t) = (1 - u)^2 ((1 + 2 u) c0 + u T c0'),   c(T) = c'(T) = 0
/// The coupling acts with its full stiffness K towards position p_WT + c and velocity v_WT + c'. At the start its
/// spring and damper are unloaded, so the force does not jump, however far away the thread is. If the thread cannot
/// follow, the force grows by at most 1.5 K |c0| / T per second. O(1), no allocation.
class Closing {
 public:
  static constexpr double kTime_s = 0.05;  ///< fingers close in about 0.1 s; an offset of 5 mm moves at <= 0.15 m/s

  /// @param c_m, c_m_per_s  position and velocity of the thread relative to the tool
  void start(const Vec3& c_m, const Vec3& c_m_per_s) noexcept {
    from_m_ = offset_m_ = c_m;
    from_m_per_s_ = rate_m_per_s_ = c_m_per_s;
    left_s_ = kTime_s;
  }
  void forget() noexcept { *this = Closing{}; }
  /// Advances by a tick of dt_s. rate_m_per_s() is then the mean rate of the offset in this tick.
  void step(double dt_s) noexcept {
    const Vec3 before_m = offset_m_;
    left_s_ = std::max(0.0, left_s_ - dt_s);
    const double rest = left_s_ / kTime_s, u = 1.0 - rest;
    offset_m_ = rest * rest * ((1.0 + 2.0 * u) * from_m_ + u * kTime_s * from_m_per_s_);
    rate_m_per_s_ = (offset_m_ - before_m) / dt_s;
  }

  [[nodiscard]] const Vec3& offset_m() const noexcept { return offset_m_; }
  [[nodiscard]] const Vec3& rate_m_per_s() const noexcept { return rate_m_per_s_; }
  /// The tool with the offset added: the point that pulls the thread.
  [[nodiscard]] ToolInput ease(ToolInput tool) const noexcept {
    tool.p_WT += offset_m_;
    tool.v_WT += rate_m_per_s_;
    return tool;
  }
  LIGATURE_MEMBERS(Closing, from_m, from_m_per_s, offset_m, rate_m_per_s, left_s)

 private:
  Vec3 from_m_ = Vec3::Zero(), from_m_per_s_ = Vec3::Zero(), offset_m_ = Vec3::Zero(), rate_m_per_s_ = Vec3::Zero();
  double left_s_ = 0.0;
};

}  // namespace ligature::physics
