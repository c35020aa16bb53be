#pragma once
// A hand steered by a remote person: follows targets at the speed of an arm, and releases the dead-man if no message
// comes.

#include <array>
#include <ruckig/ruckig.hpp>

#include "sim_device/intention.hpp"

namespace ligature::sim {

/// Limits of an arm's unhurried motion, for each axis of D; the device's own speed limit is 2 m/s.
struct ArmLimits {
  double speed_m_per_s = 0.3;
  double acceleration_m_per_s2 = 4.0;
  double jerk_m_per_s3 = 100.0;
};

/// Moves with limited jerk from its present state to rest at the newest target. After kLongestSilence_s without a
/// message it stops and releases the dead-man. The dead-man can be pressed again only after a message in which it is
/// released.
class SteeredHand final : public Intention {
 public:
  /// Twice the 100 ms for which a page that renders in software may be busy; still too short for a person to notice.
  static constexpr double kLongestSilence_s = 0.2;

  explicit SteeredHand(const Linkage& linkage, const ArmLimits& limits = {});

  /// @param t_s must not decrease; ignored before the start (minus infinity)
  /// @param p_D_m target; if out of reach, it is moved towards home until reachable
  void wish(double t_s, const Vec3& p_D_m, bool dead_man, bool grip) noexcept;

  [[nodiscard]] Intent at(double t_s, const Touch&) const noexcept override { return at(t_s); }
  [[nodiscard]] Intent at(double t_s) const noexcept;
  [[nodiscard]] double end_s() const noexcept override { return kEndless_s; }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return linkage_.home_D_m(); }

 private:
  using Axes = std::array<double, 3>;
  struct Motion {
    Axes p{}, v{}, a{};
  };
  using Trajectory = ruckig::Trajectory<3>;

  [[nodiscard]] bool is_silent(double t_s) const noexcept { return t_s > heard_s_ + kLongestSilence_s; }
  [[nodiscard]] Motion motion(double t_s) const noexcept;
  [[nodiscard]] Vec3 within_reach(const Vec3& p_D_m) const noexcept;
  void plan(const Motion& from, const Vec3& to_D_m) noexcept;
  [[nodiscard]] ruckig::InputParameter<3> beginning(const Motion& from) const noexcept;

  static constexpr double kNever_s = -1e300;

  Linkage linkage_;
  ArmLimits limits_;
  ruckig::Ruckig<3> planner_;
  Trajectory towards_, halt_;  // start at heard_s_, and kLongestSilence_s later
  Motion rest_;                // where the hand stays while there is no plan
  bool has_plan_ = false, dead_man_ = false, grip_ = false;
  bool must_release_ = true;  // the dead-man must be released once before it counts
  double heard_s_ = kNever_s;
};

}  // namespace ligature::sim
