#pragma once
// Smooth motions that the loop plans with the library Ruckig: the gain's ramp, braking to rest, guided moves.

#include <algorithm>
#include <array>
#include <cmath>
#include <ruckig/ruckig.hpp>

#include "firmware/physics/types.hpp"

namespace ligature::control {

/// A value in 0 .. 1, the gain of a hand, that moves to 0 or 1 along a jerk-limited curve. A full move from 0 to 1
/// takes exactly the duration D, because speed v, acceleration a and jerk j are limited to
///   v <= 1.5 / D,  a <= 6 / D^2,  j <= 72 / D^3     (D (2/3 + 1/4 + 1/12) = D)
/// A new target starts from the present value, speed and acceleration. Ruckig has a fixed size of one degree of freedom
/// here: no allocation, and about 1 us when the target changes, less otherwise.
class Ramp {
 public:
  explicit Ramp(double period_s) : period_s_(period_s) {
    input_.current_position[0] = input_.current_velocity[0] = input_.current_acceleration[0] = 0.0;
    input_.target_position[0] = input_.target_velocity[0] = input_.target_acceleration[0] = 0.0;
    set_duration(1.0);
  }

  double step(double target, double duration_s) noexcept {
    if (target != input_.target_position[0]) {
      set_duration(duration_s);
      input_.target_position[0] = target;
      at_s_ = 0.0;
      plans_ = otg_.calculate(input_, plan_) >= ruckig::Result::Working;
    }
    if (value_ == target && input_.current_velocity[0] == 0.0) return value_;
    at_s_ += period_s_;
    if (plans_) {
      plan_.at_time(at_s_, input_.current_position, input_.current_velocity, input_.current_acceleration);
      value_ = std::clamp(input_.current_position[0], 0.0, 1.0);
    }
    if (!plans_ || at_s_ >= plan_.get_duration() || std::abs(value_ - target) < kNear) settle(target);
    return value_;
  }
  /// Sets the value at once, with zero speed and acceleration.
  void settle(double value) noexcept {
    value_ = value;
    input_.current_position[0] = input_.target_position[0] = value;
    input_.current_velocity[0] = input_.current_acceleration[0] = 0.0;
  }
  [[nodiscard]] double value() const noexcept { return value_; }

 private:
  static constexpr double kNear = 1e-9;

  void set_duration(double D) noexcept {
    input_.max_velocity[0] = 1.5 / D;
    input_.max_acceleration[0] = 6.0 / (D * D);
    input_.max_jerk[0] = 72.0 / (D * D * D);
  }

  // Planned with calculate() rather than update(), because update() reads the clock.
  ruckig::Ruckig<1> otg_;
  ruckig::InputParameter<1> input_;
  ruckig::Trajectory<1> plan_;
  bool plans_ = false;
  double period_s_, at_s_ = 0.0, value_ = 0.0;
};

/// Reference motion of a device's tip along a planned path in space; step() advances it by one period. No allocation.
class PlannedPath {
 public:
  /// Advances by one period.
  void step() noexcept {
    if (!plans_) return;  // planning failed: the reference stays in place
    at_s_ += period_s_;
    std::array<double, 3> p{}, v{}, a{};
    plan_.at_time(at_s_, p, v, a);
    p_m_ = physics::Vec3(p[0], p[1], p[2]);
    v_m_per_s_ = physics::Vec3(v[0], v[1], v[2]);
  }
  [[nodiscard]] bool is_done() const noexcept { return !plans_ || at_s_ >= plan_.get_duration(); }
  [[nodiscard]] const physics::Vec3& position_m() const noexcept { return p_m_; }
  [[nodiscard]] const physics::Vec3& velocity_m_per_s() const noexcept { return v_m_per_s_; }

 protected:
  PlannedPath(double period_s, double acceleration_m_per_s2, double jerk_m_per_s3) : period_s_(period_s) {
    input_.max_acceleration.fill(acceleration_m_per_s2);
    input_.max_jerk.fill(jerk_m_per_s3);
    input_.current_acceleration.fill(0.0);
    input_.target_velocity.fill(0.0);
    input_.target_acceleration.fill(0.0);
  }
  /// Plans from this position and velocity to the target that the derived class has set. @return false if planning
  /// fails.
  bool plan(const physics::Vec3& p_m, const physics::Vec3& v_m_per_s) noexcept {
    input_.current_position = {p_m[0], p_m[1], p_m[2]};
    input_.current_velocity = {v_m_per_s[0], v_m_per_s[1], v_m_per_s[2]};
    p_m_ = p_m;
    v_m_per_s_ = v_m_per_s;
    at_s_ = 0.0;
    return plans_ = otg_.calculate(input_, plan_) >= ruckig::Result::Working;
  }

  ruckig::InputParameter<3> input_;

 private:
  ruckig::Ruckig<3> otg_;
  ruckig::Trajectory<3> plan_;
  bool plans_ = false;
  double period_s_, at_s_ = 0.0;
  physics::Vec3 p_m_ = physics::Vec3::Zero(), v_m_per_s_ = physics::Vec3::Zero();
};

/// Reference motion that brings a tip to rest: it starts with the tip's position and velocity, and stops with at most
/// kDeceleration_m_per_s2 and kJerk_m_per_s3 on each axis.
class BrakeToRest : public PlannedPath {
 public:
  static constexpr double kDeceleration_m_per_s2 = 60.0;  ///< 2 m/s to rest in about 50 ms
  static constexpr double kJerk_m_per_s3 = 6000.0;

  explicit BrakeToRest(double period_s) : PlannedPath(period_s, kDeceleration_m_per_s2, kJerk_m_per_s3) {
    input_.control_interface = ruckig::ControlInterface::Velocity;
  }
  void start(const physics::Vec3& p_m, const physics::Vec3& v_m_per_s) noexcept { (void)plan(p_m, v_m_per_s); }
};

/// Reference motion along a straight line, from rest to rest, within the limits of speed, acceleration and jerk below.
class GuidedMove : public PlannedPath {
 public:
  static constexpr double kSpeed_m_per_s = 0.08, kAcceleration_m_per_s2 = 0.4, kJerk_m_per_s3 = 4.0;

  explicit GuidedMove(double period_s) : PlannedPath(period_s, kAcceleration_m_per_s2, kJerk_m_per_s3) {
    input_.synchronization = ruckig::Synchronization::Phase;  // makes the path a straight line
    input_.max_velocity.fill(kSpeed_m_per_s);
  }
  /// @return false if no path can be planned; is_done() is then true at once.
  bool start(const physics::Vec3& from_m, const physics::Vec3& to_m) noexcept {
    input_.target_position = {to_m[0], to_m[1], to_m[2]};
    return plan(from_m, physics::Vec3::Zero());
  }
};

}  // namespace ligature::control
