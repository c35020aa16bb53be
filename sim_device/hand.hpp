#pragma once
// Model of a person's arm and fingers, between the intended point H and the stylus T, in the device's base frame D. x
// is the position of the hand's mass m, F the force on the stylus:
//
//   H --[K, B]-- m --[pad]-- T         m ẍ = K (p_DH − x) + B (v_DH − ẋ) − F,   F = k (x − p_DT) + b (ẋ − v_DT)
//
// K and B are stiffness and damping of the arm, k and b those of the finger pads. With m = 0 the arm acts on the stylus
// directly. The values are assumptions within the range that studies of fingers, wrist and stylus grips report (mass 5
// .. 200 g, stiffness 50 .. 2000 N/m, damping 1 .. 25 N s/m).

#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct Hand {
  // Default, a light stylus grip: the device follows within a millimetre, but the thread's pull is still visible as
  // motion (3.3 N moves the tip by 4 mm).
  double stiffness_N_per_m = 800.0;
  double damping_N_s_per_m = 8.0;
  double mass_kg = 0.0;
  double pad_stiffness_N_per_m = 4000.0;  ///< stiffness of the fingertips; unused if mass is 0
  double pad_damping_N_s_per_m = 6.0;

  /// A grip between very loose (0) and clenched (1); values are interpolated geometrically.
  [[nodiscard]] static Hand holding(double tightness) noexcept {
    const auto between = [t = tightness](double loose, double tight) { return loose * std::pow(tight / loose, t); };
    return {between(80.0, 1600.0), between(2.0, 24.0), between(0.04, 0.20), between(1500.0, 6000.0),
            between(3.0, 12.0)};
  }
  /// Parameters for a stylus that no hand holds.
  [[nodiscard]] static Hand absent() noexcept { return {0.0, 0.0, 0.0, 0.0, 0.0}; }

  [[nodiscard]] Vec3 arm_force_D_N(const Vec3& p_DH, const Vec3& v_DH, const Vec3& p_D,
                                   const Vec3& v_D) const noexcept {
    return stiffness_N_per_m * (p_DH - p_D) + damping_N_s_per_m * (v_DH - v_D);
  }
};

/// State of one hand.
class Fingers {
 public:
  Fingers(const Hand& hand, const Vec3& p_D) : hand_(hand), p_D_(p_D) {}

  /// @return force on the stylus at (p_DT, v_DT), N, before the step; then advances the hand's mass by dt_s.
  Vec3 step(const Vec3& p_DH, const Vec3& v_DH, const Vec3& p_DT, const Vec3& v_DT, double dt_s) noexcept {
    if (hand_.mass_kg <= 0.0) return hand_.arm_force_D_N(p_DH, v_DH, p_DT, v_DT);
    Vec3 pad = hand_.pad_stiffness_N_per_m * (p_D_ - p_DT) + hand_.pad_damping_N_s_per_m * (v_D_ - v_DT);
    v_D_ += dt_s / hand_.mass_kg * (hand_.arm_force_D_N(p_DH, v_DH, p_D_, v_D_) - pad);
    p_D_ += dt_s * v_D_;
    return pad;
  }

  [[nodiscard]] const Hand& hand() const noexcept { return hand_; }
  [[nodiscard]] const Vec3& position_D_m() const noexcept { return p_D_; }
  [[nodiscard]] const Vec3& velocity_D_m_per_s() const noexcept { return v_D_; }

 private:
  Hand hand_;
  Vec3 p_D_;
  Vec3 v_D_ = Vec3::Zero();
};

}  // namespace ligature::sim
