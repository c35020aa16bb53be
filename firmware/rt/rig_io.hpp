#pragma once
// What the control law sees of the rig, and what it may ask of it. SI units; index 0 = left hand, 1 = right.

#include <array>
#include <cstdint>
#include <limits>

#include "firmware/rt/payload.hpp"

namespace ligature::rt {

inline constexpr std::size_t kHands = 2;
inline constexpr std::size_t kJoints = 3;

/// What somebody who is not this controller sent on a hand's bus.
enum class Foreign : std::uint8_t {
  kNone,
  kTorque,   ///< an RPDO
  kBeat,     ///< SYNC, or a controller's heartbeat
  kNetwork,  ///< NMT, or what changes node numbers
  kObject,   ///< an SDO request
};

/// One hand as of the last complete set of joint messages.
struct HandReading {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kJoints> q_rad{};  ///< waist, shoulder, forearm (absolute)
  /// Made in the period before the sample; kNotTold of a joint whose message has no torque.
  std::array<double, kJoints> torque_Nm{kNotTold, kNotTold, kNotTold};
  std::array<bool, kJoints> torque_limited{};  ///< the drive makes less than it was asked for
  std::array<int, kJoints> torque_held{};      ///< SYNCs since that torque's RPDO, beyond the first; where it is told
  bool grip = false;
  bool dead_man = false;
  bool clutch = false;
  bool valid = false;                ///< a complete set has arrived since the start
  bool enabled = false;              ///< every drive is in Operation enabled
  bool drive_fault = false;          ///< a drive is in Fault, sent an emergency or fell out of NMT operational
  bool buttons_stuck = false;        ///< their life sign stands still
  bool torque_astray = false;        ///< a drive says that its torque is not what was asked for, nor less
  bool bus_lost = false;             ///< the bus itself is gone
  Foreign foreign = Foreign::kNone;  ///< the first frame of somebody else in this run
  float bus_load = 0.0F;             ///< share of the period before that this hand's bus was busy, stuff bits included
  std::int32_t age_ticks = 0;        ///< periods since the last complete set; 0 = sampled at this period's SYNC
};

struct RigReading {
  std::array<HandReading, kHands> hand{};
};

/// What the drives of a hand should be doing besides torque.
enum class DriveRequest : std::uint8_t {
  kHold,     ///< power stage off; a drive in Fault stays there
  kEnable,   ///< go to Operation enabled, leaving Fault by a fault reset
  kOperate,  ///< stay in Operation enabled; a drive that falls into Fault stays there
  kStop,     ///< power stage off, and off the network: no RPDO is obeyed until the drives are set up anew
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
