#pragma once
// One hand's control law: joints in, a force that may be sent out. Who may push, and when, is the controller's
// business.

#include <array>
#include <cstdint>

#include "firmware/control/any_pose.hpp"
#include "firmware/control/dead_man.hpp"
#include "firmware/control/encoder_watch.hpp"
#include "firmware/control/engagement.hpp"
#include "firmware/control/force_limiter.hpp"
#include "firmware/control/kinematics.hpp"
#include "firmware/control/move_check.hpp"
#include "firmware/control/passivity.hpp"
#include "firmware/control/virtual_coupling.hpp"
#include "firmware/control/windings.hpp"
#include "firmware/control/window_velocity.hpp"
#include "firmware/control/workspace_map.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/rig_io.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// One hand after a tick.
struct HandState {
  JointAngles q_rad{};
  Vec3 p_WT = Vec3::Zero();
  Vec3 v_WT = Vec3::Zero();
  Vec3 f_wish_N = Vec3::Zero();    // at the device: what the coupling asks for
  Vec3 f_device_N = Vec3::Zero();  ///< after gain, limits and passivity; what the torques produce
  double gain = 0.0;
  double port_energy_J = 0.0, dissipated_J = 0.0, injected_N_s_per_m = 0.0, heat = 0.0;
  double received_J = 0.0;     ///< of port_energy_J: from the other hand's account, through the thread
  std::int16_t limits = 0;     ///< rt::LimitCode bits
  bool limited = false;        ///< the force above stands at a magnitude's limit, and the gain is 1
  std::int64_t age_ticks = 0;  ///< periods since the sample that p_WT comes from
  bool dead_man = false;       ///< the button; HandControl::dead_man_counts() whether it counts
  bool grip = false;
  bool clutch = false;
  float bus_load = 0.0F;
};

/// What the rig lets a hand do in a tick.
enum class Push : std::uint8_t { kNone, kCoupling, kBrake, kLead };

/// Where a hand may be led on request: the rig's only motion of its own.
enum class Move : std::uint8_t { kNone, kPark, kCalibrate };

/// Order of a tick: observe(), step_gain(), decide(), command(). Real time: O(1), no allocation.
class HandControl {
 public:
  HandControl(const device::Device& device, const scene::Hands& hands, double period_s) noexcept;

  /// Another scene's hands, at once. @pre no force may flow.
  void change_hands(const scene::Hands& hands) noexcept;
  void set_force_scale(double scale) noexcept { coupling_.set_force_scale(scale); }
  [[nodiscard]] double force_scale() const noexcept { return coupling_.force_scale(); }

  /// Joints to tip to world, and the force that this pose asks for. An old sample is held as it is.
  /// @param last_tick the period executed before this one; reading.age_ticks counts executed periods.
  void observe(const rt::HandReading& reading, const Grasp& grasp, std::int64_t tick, std::int64_t last_tick) noexcept;
  /// The loop stood still while this tick's samples were asked for: they may be of any time since, and tell no speed.
  void doubt_time_of(std::int64_t tick) noexcept { doubtful_tick_ = tick; }
  /// After a fault; its cause may have been booked, and was no work.
  void restart_account() noexcept { passivity_.restart(); }
  void hold_clutch(bool held) noexcept { clutch_command_ = held; }
  /// A dead-man that is pressed counts no more, until it was let go and pressed again.
  void need_new_press() noexcept { dead_man_.need_new_press(); }
  [[nodiscard]] bool dead_man_counts() const noexcept { return dead_man_.counts(); }

  void drop() noexcept {
    engagement_.drop();
    end_move();
    move_fault_ = Fault::kNone;
  }
  /// Leads the hand along a jerk-limited path as soon as the gain is full, with at most kLead_N and kLeadEnergy_J. It
  /// ends where the path ends, and earlier when the hand takes the thread or the clutch, when its tip is kStray_m off
  /// the path, or when end_move() says so. Until then nothing is gripped.
  void begin_move(Move move) noexcept;
  void end_move() noexcept;
  [[nodiscard]] bool is_led() const noexcept { return move_ != Move::kNone; }
  void step_gain(bool wanted) noexcept {
    engagement_.tick(wanted && !state_.clutch, speed_m_per_s(), is_led() ? 0.0 : state_.f_wish_N.norm());
  }
  [[nodiscard]] double gain() const noexcept { return engagement_.gain(); }

  /// The force of this tick as far as it does not depend on energy: gain or brake, then limits.
  void decide(Push push) noexcept;
  /// Torques of this tick: passivity, linkage, rounding to what the wire carries; in this order.
  [[nodiscard]] std::array<double, rt::kJoints> command(std::int64_t tick) noexcept;
  /// Both hands hold the thread: between decide() and command(), the one that is short borrows of the other.
  static void lend(std::int64_t tick, HandControl& a, HandControl& b) noexcept {
    Passivity::lend(tick, a.passivity_, a.decided_N_, b.passivity_, b.decided_N_);
  }

  [[nodiscard]] const HandState& state() const noexcept { return state_; }
  [[nodiscard]] bool is_finite() const noexcept { return finite_; }
  /// Of the last sample, or of the move that ended with it.
  [[nodiscard]] Fault encoder_fault() const noexcept {
    return move_fault_ != Fault::kNone ? move_fault_ : encoder_fault_;
  }
  /// Ticks in a row in which force was sent though the gain was 0: it goes back in steps of what may be acting.
  [[nodiscard]] int overtime_ticks() const noexcept { return overtime_ticks_; }
  [[nodiscard]] bool is_plausible() const noexcept { return linkage_.is_plausible(state_.q_rad); }
  [[nodiscard]] double speed_m_per_s() const noexcept { return v_DT_.norm(); }  ///< of the device's tip
  [[nodiscard]] bool holds() const noexcept { return holds_; }

  /// The tool as the thread shall see it in this tick.
  [[nodiscard]] physics::ToolInput tool(bool alive) const noexcept {
    return {proxy_.p_WP, proxy_.v_WP, state_.grip && alive};
  }

  /// A hand that is too fast is led to rest by these, along a reference that stops (motion.hpp).
  static constexpr double kBrake_N_per_m = 150.0, kBrake_N_s_per_m = 2.0;
  static constexpr double kLead_N = 0.5;         ///< below what an Omni-class device may do for ever
  static constexpr double kLeadEnergy_J = 0.05;  ///< 0.2 m against 0.1 N of friction, twice and more
  static constexpr double kStray_m = 0.008;      ///< somebody holds on, or an encoder lies

 private:
  void sample(const rt::HandReading& reading, std::int64_t sampled) noexcept;
  void map(const Vec3& p_DT) noexcept;
  void step_clutch(bool pressed, const Vec3& p_DT) noexcept;
  [[nodiscard]] double safe_share(const Vec3& torque_Nm) const noexcept;
  [[nodiscard]] Vec3 sendable_torque(const Vec3& f_N) const noexcept;
  [[nodiscard]] Vec3 brake_force() noexcept;
  [[nodiscard]] Vec3 lead_force() noexcept;
  void fill_state(std::int16_t limits) noexcept;

  double period_s_, quantum_Nm_, max_torque_Nm_, rated_Nm_, count_rad_;
  Linkage linkage_;
  AnyPose any_pose_;
  WorkspaceMap map_;
  VirtualCoupling coupling_;
  ForceLimiter limiter_;
  Windings windings_;
  Passivity passivity_;
  Engagement engagement_;
  DeadMan dead_man_;
  BrakeToRest brake_;
  bool braking_ = false;
  GuidedMove path_;
  MoveCheck move_check_;
  Move move_ = Move::kNone;
  bool leading_ = false;  // the path has begun
  Fault move_fault_ = Fault::kNone;
  Vec3 park_m_, scene_origin_W_m_;
  std::array<WindowVelocity, 3> velocity_;
  HandState state_;
  Proxy proxy_;
  Mat3 jacobian_ = Mat3::Identity(), from_torque_ = Mat3::Identity();  // J and J^-T of the last sample
  Vec3 decided_N_ = Vec3::Zero(), torque_Nm_ = Vec3::Zero();           // torque: as sent in the tick before
  std::int16_t decided_limits_ = 0;
  Vec3 p_DT_ = Vec3::Zero(), v_DT_ = Vec3::Zero();
  bool lets_go_ = true, finite_ = true, holds_ = false, clutch_command_ = false;
  std::int64_t sample_tick_ = -1, doubtful_tick_ = -1, commanded_tick_ = -1;
  std::int32_t last_age_ = 0;
  int overtime_ticks_ = 0;
  EncoderWatch watch_;
  Fault encoder_fault_ = Fault::kNone;
};

}  // namespace ligature::control
