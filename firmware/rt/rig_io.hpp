#pragma once
// Inputs and outputs of the control law. SI units; index 0 = left hand, 1 = right.

#include <array>
#include <cstdint>
#include <limits>

#include "firmware/rt/payload.hpp"

namespace ligature::rt {

inline constexpr std::size_t kHands = 2;
inline constexpr std::size_t kJoints = 3;

/// Kinds of frames from another controller on a hand's bus.
enum class Foreign : std::uint8_t {
  kNone,
  kTorque,   ///< an RPDO
  kBeat,     ///< SYNC, or a controller's heartbeat
  kNetwork,  ///< NMT command, or LSS, which changes node ids
  kObject,   ///< an SDO request
};

/// What a hand's link knows of one drive, or of the button module.
struct DriveStatus {
  bool is_on = true;        ///< enabled
  bool is_silent = false;   ///< its part of this period's samples has not come
  bool has_failed = false;  ///< it reports a fault, left operation by itself, or was away; see the link of its protocol
  std::uint32_t error = 0;  ///< error code that it sent; 0: none
};

/// State of one hand at the last complete set of joint messages.
struct HandReading {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kJoints> q_rad{};  ///< waist, shoulder, forearm (absolute)
  /// Torque made in the period before the sample; kNotTold for a joint whose message has no torque.
  std::array<double, kJoints> torque_Nm{kNotTold, kNotTold, kNotTold};
  /// Torque that the drive measures, with noise. It only shows whether a torque is one that nobody commanded.
  std::array<double, kJoints> measured_Nm{kNotTold, kNotTold, kNotTold};
  std::array<bool, kJoints> torque_limited{};  ///< the drive makes less torque than commanded
  std::array<bool, kJoints> torque_astray{};  ///< the drive reports a torque that is neither the commanded one nor less
  /// Number of SYNCs (counted by the drive) for which the drive has repeated an older torque because RPDOs were lost;
  /// 0: none, or the drive does not report it.
  std::array<int, kJoints> torque_held{};
  bool grip = false;
  bool dead_man = false;
  bool clutch = false;
  bool valid = false;                ///< a complete set has arrived since the start
  bool enabled = false;              ///< every drive is in Operation enabled
  bool drive_fault = false;          ///< a drive is in Fault, sent an emergency or fell out of NMT operational
  bool buttons_stuck = false;        ///< the button module's counter stands still
  bool bus_lost = false;             ///< the bus is not usable: interface down, bus-off, or peer gone
  Foreign foreign = Foreign::kNone;  ///< kind of the first frame from another controller in this run
  /// Share of the previous period in which this hand's bus was busy, stuff bits included
  float bus_load = 0.0F;
  std::int32_t age_ticks = 0;  ///< periods since the last complete set; 0: sampled at this period's SYNC
  /// For messages only: the joint whose drive is in the worst trouble; kButtonModule: the button module; -1: none.
  std::int8_t bad_joint = -1;
  std::uint32_t drive_error = 0;  ///< error code that this drive sent; 0: none
  static constexpr std::size_t kButtonModule = kJoints;

  /// Enters a drive into `enabled` (set it to true before the first call), drive_fault and bad_joint. Failed is worse
  /// than silent, and silent worse than off; of drives in equal trouble the first with an error code is named, or the
  /// first.
  void tell_drive(std::size_t joint, const DriveStatus& drive) noexcept {
    enabled = enabled && drive.is_on;
    drive_fault = drive_fault || drive.has_failed;
    const int trouble = drive.has_failed ? 3 : drive.is_silent ? 2 : drive.is_on ? 0 : 1;
    const bool is_as_bad_as_named = trouble == worst_ && (drive.error == 0 || drive_error != 0);
    if (trouble == 0 || trouble < worst_ || is_as_bad_as_named) return;
    bad_joint = static_cast<std::int8_t>(joint), worst_ = trouble, drive_error = drive.error;
  }

 private:
  int worst_ = 0;  // trouble of bad_joint
};

struct RigReading {
  std::array<HandReading, kHands> hand{};
};

/// Requested drive state.
enum class DriveRequest : std::uint8_t {
  kHold,     ///< power stage off; a drive in Fault stays there
  kEnable,   ///< go to Operation enabled, leaving Fault by a fault reset
  kOperate,  ///< stay in Operation enabled; a drive that falls into Fault stays there
  kStop,     ///< power stage off and NMT stopped: no RPDO is obeyed until the drives are set up again
};

struct HandCommand {
  std::array<double, kJoints> torque_Nm{};
  DriveRequest request = DriveRequest::kHold;
};

struct RigCommand {
  std::array<HandCommand, kHands> hand{};
};

/// Target torques as sent, per mille of rated torque.
using WireTorque = std::array<std::array<std::int16_t, kJoints>, kHands>;

static_assert(Payload<RigReading> && Payload<RigCommand>);

}  // namespace ligature::rt
