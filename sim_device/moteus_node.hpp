#pragma once
// A simulated moteus drive: one axis with CAN-FD registers. It shares no code with the controller's codec. Modes and
// watchdog are as in the maker's public firmware. It can misbehave in the ways that the controller has to find.

#include <cstdint>
#include <deque>
#include <limits>
#include <utility>

#include "protocol/can/frame.hpp"
#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// What is stored in the drive.
struct MoteusSettings {
  int home = 1;                                  ///< what it knows of its position: 0 nothing, 1 within a turn, 2 all
  int starts_in = 0;                             ///< mode after power-on
  Time prepares = std::chrono::milliseconds(3);  ///< in the modes 2 to 4, before it is on
  float damping_Nm_s_per_rev = 0.05F, damping_most_Nm = 0.1F;  ///< in the mode 11
  // Misbehaviour
  bool has_watchdog = true;
  Time answers_after{0};  ///< how late its answers are
  bool obeys_stop = true;
  bool takes_gains = true;  ///< false: kp stays as it is stored
  int fault_when_on = 0;    ///< it falls into this fault as soon as it is on
};

class MoteusNode {
 public:
  MoteusNode(std::uint32_t node, const MoteusSettings& settings);

  /// A frame on the bus. Answers go to `out`.
  void take(const can::Frame& frame, Time now);
  void advance(Time now);  ///< watchdog, modes and late answers
  [[nodiscard]] Time next_deadline() const noexcept;
  /// Power off; the drive is back after `boot`.
  void power_cycle(Time now, Time boot);
  void fail(int fault);

  /// Made at the motor.
  [[nodiscard]] float torque_Nm() const noexcept;
  [[nodiscard]] int mode() const noexcept { return mode_; }
  [[nodiscard]] bool is_on() const noexcept { return mode_ > 1; }
  [[nodiscard]] bool has_fault() const noexcept { return mode_ == 1; }
  void set_mode(int mode) noexcept { mode_ = mode; }

  bool obeys = true;    ///< false: it only answers
  bool answers = true;  ///< false: it only obeys
  std::int64_t watchdog_trips = 0;
  std::deque<can::Frame> out;
  float position_rev = 0.0F, velocity_rev_per_s = 0.0F;
  float adds_Nm = 0.0F;  ///< to the commanded torque
  int limit = 0;         ///< told in place of a fault while it is on
  MoteusSettings settings;

 private:
  /// What the last command said.
  struct Command {
    int mode = 0;
    float position = 0.0F, torque = 0.0F, kp = 1.0F, kd = 1.0F, ilimit = 1.0F;
    float most_torque = std::numeric_limits<float>::quiet_NaN(), watchdog_s = std::numeric_limits<float>::quiet_NaN();
  };
  [[nodiscard]] float* setting(std::uint32_t reg) noexcept;
  [[nodiscard]] float value(std::uint32_t reg) noexcept;
  void obey(Time now);

  std::uint32_t node_;
  int mode_ = 0, fault_ = 0;
  Command command_;
  Deadline watchdog_, ready_, powered_;
  std::deque<std::pair<Time, can::Frame>> late_;
};

}  // namespace ligature::sim
