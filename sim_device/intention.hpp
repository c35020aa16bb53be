#pragma once
// Interface of what moves a simulated person's hand: a script, a controller that sees the thread, tremor, or an
// adversary.

#include "sim_device/kinematics.hpp"

namespace ligature::sim {

inline constexpr double kEndless_s = 1e300;  ///< end time of an intention that has no end yet

/// Target of the stylus in the device's base frame D (x right, y away, z up), and the pressed buttons.
struct Intent {
  Vec3 p_DH = Vec3::Zero();
  Vec3 v_DH = Vec3::Zero();
  bool grip = false;
  bool dead_man = true;  ///< pressed, as long as the drives are on
};

/// State of the stylus.
struct Touch {
  Vec3 p_DT = Vec3::Zero();
  Vec3 v_DT = Vec3::Zero();
};

/// The result of at() depends only on the time and the state of the stylus, so that runs can be repeated bit by bit.
class Intention {
 public:
  virtual ~Intention() = default;
  /// @param t_s time since the start; minus infinity before the start. @param touch state of the stylus.
  [[nodiscard]] virtual Intent at(double t_s, const Touch& touch) const noexcept = 0;
  /// End of the intention: after this nothing changes; the dead-man is released one second later.
  [[nodiscard]] virtual double end_s() const noexcept = 0;
  /// Position at which the device rests before the start. @pre within its reach.
  [[nodiscard]] virtual Vec3 start_D_m() const noexcept = 0;
};

/// An intention whose position and velocity are set from outside once per millisecond; in between, the position is
/// extrapolated.
class HeldIntention final : public Intention {
 public:
  explicit HeldIntention(const Vec3& start_D_m) : start_D_m_(start_D_m) { intent_.p_DH = start_D_m; }

  void set(double t_s, const Intent& intent) noexcept {
    since_s_ = t_s;
    intent_ = intent;
  }
  void finish(double t_s) noexcept { end_s_ = t_s; }

  [[nodiscard]] Intent at(double t_s, const Touch&) const noexcept override {
    if (!(t_s > since_s_)) return intent_;
    Intent now = intent_;
    now.p_DH += (t_s - since_s_) * intent_.v_DH;
    return now;
  }
  [[nodiscard]] double end_s() const noexcept override { return end_s_; }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return start_D_m_; }

 private:
  Vec3 start_D_m_;
  Intent intent_;
  double since_s_ = 1e300, end_s_ = kEndless_s;
};

}  // namespace ligature::sim
