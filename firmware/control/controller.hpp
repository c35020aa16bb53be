#pragma once
// Control law of both hands: once per period it turns joint samples into torques and requests to the drives.

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/control/faults.hpp"
#include "firmware/control/hand_control.hpp"
#include "firmware/control/loss_watch.hpp"
#include "firmware/control/sample_age.hpp"
#include "firmware/control/state_machine.hpp"
#include "firmware/control/torque_watch.hpp"
#include "firmware/rt/command.hpp"
#include "firmware/rt/culprit.hpp"
#include "firmware/rt/period.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

using rt::kPeriod_s;

struct Settings {
  /// Limit in ticks for three things: age of joint messages, lost periods in a row, lateness of the physics. Reaching
  /// it is a fault
  std::int32_t watchdog_ticks = 20;
  bool armed = false;  ///< at start; a fault or a disarm clears it
  device::Device device = device::omni();
  /// Whether the energy accounts of the two hands lend to each other; false only in experiments: then no hand can pull
  /// the other
  bool lending = true;
};

/// All inputs of a tick.
struct TickInput {
  std::int64_t tick = 0;  ///< index of the period; a jump means lost periods
  rt::RigReading reading;
  std::array<Grasp, rt::kHands> grasp;  ///< newest available
  bool thread_finite = true;
  bool late = false;                   ///< the time of this tick's samples is unknown; they may be periods late
  std::int64_t grasp_age_ticks = 1;    ///< periods since the one whose tools this grasp was computed from
  std::int64_t thread_late_ticks = 0;  ///< number of tool inputs handed over that the physics has not used yet
};

/// tick() is O(1), allocates nothing, throws nothing and makes no system call. Its output depends only on its inputs.
class Controller {
 public:
  static constexpr int kCalibrationTicks = 50;  ///< consecutive ticks with possible poses
  static constexpr int kScaleTicks = 200;       ///< duration of a change of the force scale
  /// Largest number of ticks in which a force is reduced step by step after its gain has reached 0; then a fault
  /// removes the force at once. So a hand is free of force at most 50 ms + 100 ms after the dead-man is released,
  /// whatever frames are lost. Without lost frames, a force of 3.3 N takes 14 ticks.
  static constexpr int kMostOvertimeTicks = 100;
  static constexpr int kPowerDownTicks = 20;  ///< "power stage off" is sent for so many ticks before the run ends

  Controller(const scene::Hands& hands, const Settings& settings) noexcept;

  /// A request of the host or the operator; acts in the next tick.
  void command(rt::CommandKind kind) noexcept;

  /// Installs the hand settings of another scene. @pre no force can flow.
  void change_hands(const scene::Hands& hands) noexcept;
  /// Changes the force scale linearly over kScaleTicks, so that the force on the hand does not jump.
  void change_force_scale(double force_scale) noexcept;

  /// Starts the shutdown: forces ramp to zero, drives are switched off, then is_finished() is true.
  void shut_down() noexcept { shutting_down_ = true; }
  [[nodiscard]] bool is_finished() const noexcept { return powered_down_ticks_ >= kPowerDownTicks; }

  [[nodiscard]] rt::RigCommand tick(const TickInput& in) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] Fault fault() const noexcept { return fault_; }
  /// What the present fault is about. In OFF and CALIBRATE: what keeps the rig from leaving this state.
  [[nodiscard]] const rt::Culprit& culprit() const noexcept { return culprit_; }
  [[nodiscard]] bool armed() const noexcept { return armed_; }
  [[nodiscard]] const HandState& hand(std::size_t h) const noexcept { return hands_[h].state(); }

  /// The two tools for the physics in this tick.
  [[nodiscard]] std::array<physics::ToolInput, rt::kHands> tools() const noexcept;

 private:
  struct Found {
    Fault fault = Fault::kNone;
    rt::Culprit culprit{};
  };
  [[nodiscard]] Found find_fault(const TickInput& in) const noexcept;
  [[nodiscard]] Found find_hand_fault(std::size_t h, const rt::HandReading& reading) const noexcept;
  [[nodiscard]] bool is_up(std::size_t h, const rt::HandReading& reading) const noexcept;
  [[nodiscard]] rt::Culprit find_wait(const rt::RigReading& reading) const noexcept;
  void step_state(const TickInput& in) noexcept;
  /// Transition event of this tick, other than a fault.
  [[nodiscard]] std::optional<Event> find_event(const rt::RigReading& reading, bool brakes) const noexcept;
  void step_gains() noexcept;
  void step_force_scale() noexcept;
  void begin_moves(Move move) noexcept;
  [[nodiscard]] Push push(const HandControl& hand) const noexcept;
  [[nodiscard]] bool any_too_fast() const noexcept;
  [[nodiscard]] rt::DriveRequest drive_request() const noexcept;
  [[nodiscard]] bool any_full() const noexcept;
  [[nodiscard]] bool all_zero() const noexcept;
  [[nodiscard]] bool any_pushes() const noexcept;

  Settings settings_;
  std::array<SampleAge, rt::kHands> age_;
  std::array<HandControl, rt::kHands> hands_;
  std::array<TorqueWatch, rt::kHands> torque_;
  std::array<LossWatch, rt::kHands> loss_;
  double scale_goal_, scale_step_ = 0.0;
  State state_ = State::kOff;
  Fault fault_ = Fault::kNone;
  rt::Culprit culprit_;
  bool armed_;
  bool reset_requested_ = false;
  bool stop_requested_ = false;  // all torques are zero in this tick, even above the step limit
  bool shutting_down_ = false;
  bool braking_ = false;  // state BRAKE was entered because a hand was too fast
  int plausible_ticks_ = 0;
  int powered_down_ticks_ = 0;
  std::int64_t last_tick_ = -1;
};

}  // namespace ligature::control
