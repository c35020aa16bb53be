#pragma once
// One device port must never give out more energy than it was given: an exact account, and a force that it can pay for.

#include <array>
#include <cstdint>

#include "firmware/control/kinematics.hpp"

namespace ligature::control {

/// Account of a port and controller over it.
///
/// Observer. A torque sent in tick k acts from SYNC k+1 to SYNC k+2 and is constant in between, so the motors' work is
/// exact, whatever the motion was:
///   E(n) = E(n-1) - tau(n-2) . (q(n) - q(n-1))         work of the hand on the rig, J; f(n-1) dx(n) with the wire's
///   delay
/// with the torques as rounded for the wire. Credit above kCredit_J is forgotten (the window: else an hour of harmless
/// friction would pay for a minute of instability). The start is 0 plus the scene's energy_credit_J.
///
/// Controller. Torques sent are spent money: one is on its way when the next is decided, and the hand may turn round. A
/// hand that gives the tip at most the acceleration a moves it, in the j-th period after the last sample, by dx + e
/// with |e| <= j a T^2 + c (dx: the last period's motion, c: one count). What force F can lose there is
///   out_j(F) = max(0, F . dx + |F| (j a T^2 + c)),
/// and a force is sent only when E minus the losses of all torques under way minus its own stays above -kFloor_J. One
/// that is not is first damped against the motion (alpha = shortage / (T v^2), at most kMaxDamping, v at least kSlow),
/// then reduced. So E stays above -kFloor_J for every hand within that acceleration, without looking at the
/// environment. O(1), no allocation. The bound on acceleration is the device record's, the proof by play is in the
/// tests.
class Passivity {
 public:
  static constexpr double kFloor_J = 1e-6;
  static constexpr double kCredit_J = 0.02;             ///< a 3.3 N spring of 270 N/m, or a 0.88 N one of 19 N/m
  static constexpr double kMaxDamping_N_s_per_m = 5.0;  ///< what a device of the class can render at 1 kHz
  static constexpr double kSlow_m_per_s = 5e-3;         ///< below, a velocity is mostly counts
  static constexpr std::size_t kMemory = 64;            ///< ticks; longer than any watchdog

  Passivity(const device::Device& device, double period_s, bool active, double credit_J) noexcept;

  /// A new sample: books the work since the last one. `periods` whole periods lie between, evenly moved through.
  void observe(std::int64_t tick, const JointAngles& q_rad, const Vec3& p_m, double tip_per_count_m) noexcept;

  /// The force that may be sent in tick `tick`, >= the last observed. Only looks; sent() books it.
  [[nodiscard]] Vec3 control(std::int64_t tick, const Vec3& f_N, const Vec3& v_m_per_s) noexcept;
  /// Whether exactly this tip force may be sent in `tick`: control()'s last word once torques are rounded.
  [[nodiscard]] bool allows(std::int64_t tick, const Vec3& f_N) const noexcept;
  /// What went out in `tick`, and the tip force it makes.
  void sent(std::int64_t tick, const Vec3& torque_Nm, const Vec3& f_N) noexcept;

  /// While both hands hold the thread it carries energy from one to the other: they share what they have.
  static void share(Passivity& a, Passivity& b) noexcept;

  /// Off: the account is kept, nothing is held back. @pre no force flows.
  void set_active(bool active) noexcept { active_ = active; }

  [[nodiscard]] double energy_J() const noexcept { return energy_J_; }
  [[nodiscard]] double dissipated_J() const noexcept { return dissipated_J_; }
  [[nodiscard]] double injected_N_s_per_m() const noexcept { return injected_; }
  [[nodiscard]] bool acts() const noexcept { return acts_; }

 private:
  struct Sent {
    Vec3 torque_Nm = Vec3::Zero();
    Vec3 f_N = Vec3::Zero();
  };
  [[nodiscard]] const Sent& in_tick(std::int64_t tick) const noexcept;
  [[nodiscard]] double loss_J(const Vec3& f_N, std::int64_t period) const noexcept;
  [[nodiscard]] double room_J(std::int64_t tick) const noexcept;

  double period_s_, reach_m_;  // a T^2
  bool active_;
  double energy_J_, dissipated_J_ = 0.0, injected_ = 0.0, count_m_ = 0.0;
  bool acts_ = false;
  std::int64_t sampled_ = -1, last_sent_ = -1;
  JointAngles q_rad_{};
  Vec3 p_m_ = Vec3::Zero(), step_m_ = Vec3::Zero();  // step: motion of the last observed period
  std::array<Sent, kMemory> memory_{};
};

}  // namespace ligature::control
