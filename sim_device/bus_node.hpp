#pragma once
// A drive of a simulated hand, whatever its protocol: as the bus and the mechanics see it.

#include <cstdint>
#include <vector>

#include "protocol/can/frame.hpp"
#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// Sensor readings of a drive at one moment.
struct Sensed {
  std::int32_t position_counts = 0;
  std::uint16_t buttons = 0;
  bool guarded = false;              ///< the power stage limits the torque to protect the winding
  std::int16_t torque_permille = 0;  ///< the limited torque, if guarded
  double velocity_rad_per_s = 0.0;
};

struct DriveStats {
  std::int64_t watchdog_trips = 0;      ///< times that the drive removed torque by itself
  std::int64_t syncs_without_rpdo = 0;  ///< SYNCs without a new RPDO while in Operation Enabled
  std::int64_t late_rpdos = 0;  ///< RPDOs replaced by a second one before the next SYNC, so that they had no effect
};

/// What a controller's frame is for.
enum class Meaning : std::uint8_t {
  kOther,
  kPeriod,        ///< begins a period of the controller
  kTorque,        ///< a torque that acts at once
  kTorqueAtSync,  ///< a torque that acts at the next SYNC
  kState,         ///< may switch a drive on or off at once
  kSilent,        ///< no drive answers it
};

/// Every call appends the frames that the drive sends to `out`. Time must not run backwards.
class BusNode {
 public:
  virtual ~BusNode() = default;

  virtual void power_on(Time now, std::vector<can::Frame>& out) = 0;
  /// No torque from now on.
  virtual void power_off() noexcept = 0;
  virtual void on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) = 0;
  /// Checks watchdogs and sends what is due. Call again at next_deadline().
  virtual void poll(Time now, const Sensed& sensed, std::vector<can::Frame>& out) = 0;
  [[nodiscard]] virtual Time next_deadline() const noexcept = 0;
  [[nodiscard]] virtual Meaning meaning_of(const can::Frame& frame) const noexcept = 0;

  /// Torque that the motor makes now, at the joint.
  [[nodiscard]] virtual double torque_Nm() const noexcept = 0;
  [[nodiscard]] virtual bool is_enabled() const noexcept = 0;
  [[nodiscard]] virtual bool has_fault() const noexcept = 0;
  [[nodiscard]] virtual DriveStats stats() const noexcept = 0;
  /// A controller that tries the drives at start-up, as it must where it cannot read their settings, sends torques in
  /// fewer consecutive periods than this. 0: it does not try them.
  [[nodiscard]] virtual int trial_periods() const noexcept { return 0; }

 protected:
  BusNode() = default;
  BusNode(const BusNode&) = default;
  BusNode& operator=(const BusNode&) = default;
};

}  // namespace ligature::sim
