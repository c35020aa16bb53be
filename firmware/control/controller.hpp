#pragma once
// Both hands' control law: what the joints say in, what the drives shall do out. One call a period.

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/control/faults.hpp"
#include "firmware/control/hand_control.hpp"
#include "firmware/control/loss_watch.hpp"
#include "firmware/control/state_machine.hpp"
#include "firmware/control/torque_watch.hpp"
#include "firmware/rt/command.hpp"
#include "firmware/rt/period.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

using rt::kPeriod_s;

struct Settings {
  std::int32_t watchdog_ticks = 20;  ///< age of joint messages, periods lost or thread late in a row, that is a fault
  bool armed = false;                ///< at start; a fault and a disarm take it back
  device::Device device = device::omni();
  bool lending = true;  ///< off: each hand must earn its force alone, and cannot be pulled (an experiment shows it)
};

/// All that a tick depends on.
struct TickInput {
  std::int64_t tick = 0;  ///< number of the period; a jump means lost periods
  rt::RigReading reading;
  std::array<Grasp, rt::kHands> grasp;  ///< the newest there is
  bool thread_finite = true;
  bool late = false;  ///< the samples asked for in this tick were taken nobody knows when, periods late perhaps
  std::int64_t grasp_age_ticks = 1;    ///< since the period whose tools that grasp has seen
  std::int64_t thread_late_ticks = 0;  ///< tools handed over that it has not seen
};

/// Real time: tick() is O(1), allocates nothing, throws nothing, calls no system. Deterministic in its inputs.
class Controller {
 public:
  static constexpr int kCalibrationTicks = 50;  ///< of possible poses in a row
  static constexpr int kScaleTicks = 200;       ///< that a change of the force scale takes
  /// That a force may take to end in steps once its gain is 0; then all of it goes at once, by a fault. Whoever lets go
  /// is rid of it 50 ms + this later, whatever the wire loses and the drives do. Without losses 3.3 N need 14.
  static constexpr int kMostOvertimeTicks = 100;
  static constexpr int kPowerDownTicks = 20;  ///< of "power stage off" sent before the run ends

  Controller(const scene::Hands& hands, const Settings& settings) noexcept;

  /// A request of the host or the operator; acts in the next tick.
  void command(rt::CommandKind kind) noexcept;

  /// Another scene's hands, at once. @pre no force may flow.
  void change_hands(const scene::Hands& hands) noexcept;
  /// Goes to another force scale over kScaleTicks, so that a held force changes without a jump.
  void change_force_scale(double force_scale) noexcept;

  /// Begins the end: forces ramp to zero, drives are switched off, then is_finished().
  void shut_down() noexcept { shutting_down_ = true; }
  [[nodiscard]] bool is_finished() const noexcept { return powered_down_ticks_ >= kPowerDownTicks; }

  [[nodiscard]] rt::RigCommand tick(const TickInput& in) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] Fault fault() const noexcept { return fault_; }
  [[nodiscard]] bool armed() const noexcept { return armed_; }
  [[nodiscard]] const HandState& hand(std::size_t h) const noexcept { return hands_[h].state(); }

  /// The two tools as the thread shall see them in this tick.
  [[nodiscard]] std::array<physics::ToolInput, rt::kHands> tools() const noexcept;

 private:
  [[nodiscard]] Fault find_fault(const TickInput& in) const noexcept;
  [[nodiscard]] Fault find_hand_fault(const HandControl& hand, const rt::HandReading& reading) const noexcept;
  [[nodiscard]] bool drives_are_up(const rt::RigReading& reading) const noexcept;
  void step_state(const TickInput& in) noexcept;
  /// What leads out of the state that is no fault.
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
  std::array<HandControl, rt::kHands> hands_;
  std::array<TorqueWatch, rt::kHands> torque_;
  std::array<LossWatch, rt::kHands> loss_;
  double scale_goal_, scale_step_ = 0.0;
  State state_ = State::kOff;
  Fault fault_ = Fault::kNone;
  bool armed_;
  bool reset_requested_ = false;
  bool stop_requested_ = false;  // in this tick no hand gets a torque, whatever the step limit says
  bool shutting_down_ = false;
  bool braking_ = false;  // BRAKE because a hand was too fast
  int plausible_ticks_ = 0;
  int powered_down_ticks_ = 0;
  std::int64_t last_tick_ = -1;
};

}  // namespace ligature::control
