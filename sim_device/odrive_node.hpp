#pragma once
// A simulated ODrive with CANSimple, software 0.6: one axis. It shares no code with the controller's codec. It can
// misbehave in the ways that start-up has to find.

#include <deque>

#include "protocol/can/remote.hpp"
#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// What is stored in the drive. A power cycle brings it back.
struct OdriveSettings {
  Time watchdog = std::chrono::milliseconds(20);  ///< 0: off
  Time heartbeat = std::chrono::milliseconds(10);
  std::uint32_t control_mode = 3, input_mode = 1;  ///< 3: position, 1: passthrough, as delivered
  float current_limit_A = 60.0F;
  bool starts_in_closed_loop = false;
  int software_minor = 6;
  // Misbehaviour
  bool has_old_watchdog = false;  ///< as in software 0.5: every frame feeds it, and it also runs while the drive is off
  Time tells_position{0};         ///< period of its positions that nobody asked for; 0: none
  bool takes_mode = true;
  float adds_Nm = 0.0F;             ///< in every second answer about its torque
  bool takes_short_torques = true;  ///< torque messages of 4 bytes
  bool obeys_idle = true;
  bool has_error = false;  ///< one that cannot be cleared
};

class OdriveNode {
 public:
  /// Of the control of position and velocity, as delivered.
  static constexpr float kPosition_per_s = 20.0F, kVelocity_Nm_s_per_rev = 0.167F;

  OdriveNode(std::uint32_t node, const OdriveSettings& settings, Time now);

  /// A frame on the bus. Answers go to `out`.
  void take(const can::Frame& frame, Time now);
  void advance(Time now);  ///< watchdog and heartbeat
  [[nodiscard]] Time next_deadline() const noexcept;
  /// Power off; the drive is back after `boot`.
  void power_cycle(Time now, Time boot);

  /// Made at the motor.
  [[nodiscard]] float torque_Nm() const noexcept;
  [[nodiscard]] bool is_on() const noexcept { return state_ == 8; }
  [[nodiscard]] float current_limit_A() const noexcept { return current_limit_A_; }
  void fail() noexcept { disarm(0x20); }  ///< of the power stage

  [[nodiscard]] bool has_error() const noexcept { return error_ != 0; }

  bool obeys = true;  ///< false: it only answers
  std::int64_t watchdog_trips = 0;
  std::deque<can::Frame> out;
  float position_rev = 0.0F;

 private:
  void command(std::uint32_t number, const can::Frame& frame, Time now);
  void answer(std::uint32_t number);
  void request_state(std::uint32_t state, Time now);
  void disarm(std::uint32_t error) noexcept;
  void feed(Time now) noexcept;
  void boot(Time now);
  void send(std::uint32_t number, std::uint32_t low, std::uint32_t high);

  std::uint32_t node_;
  OdriveSettings settings_;
  std::uint32_t state_ = 1, error_ = 0, control_mode_ = 0, input_mode_ = 0;
  float input_torque_Nm_ = 0.0F, input_rev_ = 0.0F, input_rev_per_s_ = 0.0F, current_limit_A_ = 0.0F;
  bool adds_ = false;
  Deadline watchdog_, beat_, powered_, position_;
};

}  // namespace ligature::sim
