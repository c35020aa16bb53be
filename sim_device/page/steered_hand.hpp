#pragma once
// A hand that somebody steers from afar: it goes where it is wished, as fast as an arm does, and lets go when it hears
// nothing.

#include <array>
#include <ruckig/ruckig.hpp>

#include "sim_device/intention.hpp"

namespace ligature::sim {

/// What an arm at a desk does without haste; the device's own limit is 2 m/s. By axis of D.
struct ArmLimits {
  double speed_m_per_s = 0.3;
  double acceleration_m_per_s2 = 4.0;
  double jerk_m_per_s3 = 100.0;
};

/// Jerk-limited from wherever it is to the newest wish, at rest there. After kLongestSilence_s without a wish it comes
/// to rest on the spot with the dead-man let go, and the dead-man counts again only after it was wished released.
class SteeredHand final : public Intention {
 public:
  /// A page that draws in software may be busy for 100 ms; who steers notices less than twice that.
  static constexpr double kLongestSilence_s = 0.2;

  explicit SteeredHand(const Linkage& linkage, const ArmLimits& limits = {});

  /// @param t_s not before the last one; before the start (minus infinity) nothing is taken.
  /// @param p_D_m what is out of reach is brought back towards home.
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
  Trajectory towards_, halt_;  // from heard_s_ on, and from kLongestSilence_s later
  Motion rest_;                // while there is no plan
  bool has_plan_ = false, dead_man_ = false, grip_ = false;
  bool must_release_ = true;  // the dead-man, before it counts
  double heard_s_ = kNever_s;
};

}  // namespace ligature::sim
