#pragma once
// Control law of one hand: from joint samples to torques that are safe to send. The controller (controller.hpp) decides
// when a hand may push.

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
#include "firmware/control/sample_age.hpp"
#include "firmware/control/virtual_coupling.hpp"
#include "firmware/control/windings.hpp"
#include "firmware/control/window_velocity.hpp"
#include "firmware/control/workspace_map.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/rig_io.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// State of one hand after a tick.
struct HandState {
  JointAngles q_rad{};
  Vec3 p_WT = Vec3::Zero();
  Vec3 v_WT = Vec3::Zero();
  Vec3 f_wish_N = Vec3::Zero();    ///< at the device: the force that the coupling asks for
  Vec3 f_device_N = Vec3::Zero();  ///< after gain, limits and passivity, as made by the torques sent
  double gain = 0.0;
  double port_energy_J = 0.0, dissipated_J = 0.0, injected_N_s_per_m = 0.0, heat = 0.0;
  /// Part of port_energy_J that does not come from this hand: lent by the other hand's account, or granted for a guided
  /// move
  double received_J = 0.0;
  std::int16_t limits = 0;     ///< rt::LimitCode bits
  bool limited = false;        ///< f_device_N is at a magnitude limit while the gain is 1
  std::int64_t age_ticks = 0;  ///< periods since the sample that p_WT comes from
  bool dead_man = false;       ///< the button as read; HandControl::dead_man_counts() says whether it counts
  bool grip = false;
  bool clutch = false;
  float bus_load = 0.0F;
};

/// Source of the hand's force in a tick: none, the coupling, the velocity brake, or a guided move.
enum class Push : std::uint8_t { kNone, kCoupling, kBrake, kLead };

/// Guided moves: the only motions that the rig makes by itself, and only on a command.
enum class Move : std::uint8_t { kNone, kPark, kCalibrate };

/// Call in each tick, in this order: observe(), step_gain(), decide(), command(). O(1), no allocation.
class HandControl {
 public:
  HandControl(const device::Device& device, const scene::Hands& hands, double period_s) noexcept;

  /// Installs the hand settings of another scene. @pre no force can flow.
  void change_hands(const scene::Hands& hands) noexcept;
  void set_force_scale(double scale) noexcept { coupling_.set_force_scale(scale); }
  [[nodiscard]] double force_scale() const noexcept { return coupling_.force_scale(); }

  /// Computes the tip's position, the tool's position in the world and the coupling's force from the joint angles.
  /// Without a new sample, the last one is used again.
  /// @param age age of the sample; age.look() was already called with this reading
  void observe(const rt::HandReading& reading, const SampleAge& age, const Grasp& grasp, std::int64_t tick) noexcept;
  /// Call when the loop was delayed while it read this tick's samples. Their time is then unknown, so no velocity is
  /// computed from them.
  void doubt_time_of(std::int64_t tick) noexcept { doubtful_tick_ = tick; }
  /// Resets the energy account after a fault. The cause of the fault, such as an encoder jump, may have been booked as
  /// work.
  void restart_account() noexcept { passivity_.restart(); }
  void hold_clutch(bool held) noexcept { clutch_command_ = held; }
  /// A pressed dead-man no longer counts until it is released and pressed again.
  void need_new_press() noexcept { dead_man_.need_new_press(); }
  [[nodiscard]] bool dead_man_counts() const noexcept { return dead_man_.counts(); }

  void drop() noexcept {
    engagement_.drop();
    end_move();
    move_fault_ = {};
  }
  /// Guides the hand along a jerk-limited path with at most kLead_N of force and kLeadEnergy_J of energy, once the gain
  /// is 1. The move ends with the path, or earlier if the hand holds the thread, the clutch is pressed, the tip is
  /// kStray_m off the path, or end_move() is called. Until the end the gripper stays open.
  void begin_move(Move move) noexcept;
  void end_move() noexcept;
  [[nodiscard]] bool is_led() const noexcept { return move_ != Move::kNone; }
  void step_gain(bool wanted) noexcept {
    engagement_.tick(wanted && !state_.clutch, speed_m_per_s(), is_led() ? 0.0 : state_.f_wish_N.norm());
  }
  [[nodiscard]] double gain() const noexcept { return engagement_.gain(); }

  /// Computes the force of this tick, without regard to the energy account: the force of `push` times gain, then the
  /// limits.
  void decide(Push push) noexcept;
  /// Torques of this tick: passivity control of the force f, joint torques J^T f, rounding to torque quanta.
  [[nodiscard]] std::array<double, rt::kJoints> command(std::int64_t tick) noexcept;
  /// Call between decide() and command() while both hands hold the thread: a hand whose account cannot pay for its
  /// force borrows energy from the other hand's.
  static void lend(std::int64_t tick, HandControl& a, HandControl& b) noexcept {
    Passivity::lend(tick, a.passivity_, a.decided_N_, b.passivity_, b.decided_N_);
  }

  [[nodiscard]] const HandState& state() const noexcept { return state_; }
  [[nodiscard]] bool is_finite() const noexcept { return finite_; }
  /// Encoder fault found in the last sample, or by a guided move that ended at that sample.
  [[nodiscard]] JointFault encoder_fault() const noexcept {
    return move_fault_ != JointFault{} ? move_fault_ : encoder_fault_;
  }
  /// Whether samples may be coming in a burst, in which one period brings several periods of motion. That happens after
  /// the process of a simulated hand has stood still. True after a gap in the samples, for as many periods as the gap
  /// was long.
  [[nodiscard]] bool is_catching_up() const noexcept { return catching_up_ > 0; }
  /// Consecutive ticks in which there is still force although the gain is 0, because the step limit lets force fall
  /// only gradually.
  [[nodiscard]] int overtime_ticks() const noexcept { return overtime_ticks_; }
  [[nodiscard]] bool is_plausible() const noexcept { return linkage_.is_plausible(state_.q_rad); }
  [[nodiscard]] double speed_m_per_s() const noexcept { return v_DT_.norm(); }  ///< speed of the device's tip
  [[nodiscard]] bool holds() const noexcept { return holds_; }

  /// The tool for the physics in this tick. @param alive false: the hand's samples are too old, so its gripper opens.
  [[nodiscard]] physics::ToolInput tool(bool alive) const noexcept {
    return {proxy_.p_WP, proxy_.v_WP, state_.grip && alive};
  }

  /// Spring and damper of the velocity brake: they pull a hand that is too fast towards a reference that decelerates to
  /// rest (motion.hpp).
  static constexpr double kBrake_N_per_m = 150.0, kBrake_N_s_per_m = 2.0;
  static constexpr double kLead_N = 0.5;         ///< below the continuous force of an Omni-class device
  static constexpr double kLeadEnergy_J = 0.05;  ///< more than twice the work of moving 0.2 m against 0.1 N of friction
  static constexpr double kStray_m = 0.008;      ///< larger deviation: somebody holds the tip, or an encoder is wrong

 private:
  void sample(const rt::HandReading& reading, std::int64_t sampled) noexcept;
  void map(const Vec3& p_DT) noexcept;
  void step_clutch(bool pressed, const Vec3& p_DT) noexcept;
  [[nodiscard]] double safe_share(const Vec3& torque_Nm) const noexcept;
  [[nodiscard]] double allowed_share(const Vec3& f_N, const Vec3& torque_Nm) const noexcept;
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
  JointFault move_fault_;
  Vec3 park_m_, scene_origin_W_m_;
  std::array<WindowVelocity, 3> velocity_;
  HandState state_;
  Proxy proxy_;
  Mat3 jacobian_ = Mat3::Identity(), from_torque_ = Mat3::Identity();  // J and J^-T of the last sample
  Vec3 decided_N_ = Vec3::Zero(), torque_Nm_ = Vec3::Zero();           // torque: sent in the tick before
  std::int16_t decided_limits_ = 0;
  Vec3 p_DT_ = Vec3::Zero(), v_DT_ = Vec3::Zero();
  bool lets_go_ = true, finite_ = true, holds_ = false, clutch_command_ = false;
  std::int64_t sample_tick_ = -1, doubtful_tick_ = -1, commanded_tick_ = -1;
  std::int64_t catching_up_ = 0;  // samples for which is_catching_up() holds
  int overtime_ticks_ = 0;
  EncoderWatch watch_;
  JointFault encoder_fault_;
};

}  // namespace ligature::control
