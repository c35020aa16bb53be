#pragma once
// Object dictionary entries that the rig uses (CiA 301 communication, CiA 402 drive profile, manufacturer-specific).

#include <compare>
#include <cstdint>

namespace ligature::can {

/// Index and sub-index of one dictionary entry.
struct Object {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  friend constexpr auto operator<=>(const Object&, const Object&) = default;
};

namespace od {
inline constexpr Object kDeviceType{0x1000, 0};
inline constexpr Object kErrorRegister{0x1001, 0};
inline constexpr Object kConsumerHeartbeat{0x1016, 1};  ///< (node to monitor << 16) | longest silence in ms
inline constexpr Object kProducerHeartbeat{0x1017, 0};  ///< period of the heartbeat, ms; 0: off
inline constexpr Object kVendorId{0x1018, 1};
inline constexpr Object kRpdo1CobId{0x1400, 1};  ///< bit 31 set: PDO disabled
inline constexpr Object kRpdo1TransmissionType{0x1400, 2};
inline constexpr Object kRpdo1EventTimer{0x1400, 5};  ///< ms without RPDO until the drive faults; 0: off
inline constexpr Object kRpdo1MapCount{0x1600, 0};
inline constexpr Object kTpdo1CobId{0x1800, 1};
inline constexpr Object kTpdo1TransmissionType{0x1800, 2};
inline constexpr Object kTpdo1MapCount{0x1A00, 0};
inline constexpr Object kStylusButtons{0x2100, 1};          ///< bits: profile::kButton*, with_held(), with_life()
inline constexpr Object kAbortConnectionOption{0x6007, 0};  ///< reaction to a lost connection; 1: fault
inline constexpr Object kErrorCode{0x603F, 0};
inline constexpr Object kControlword{0x6040, 0};
inline constexpr Object kStatusword{0x6041, 0};
inline constexpr Object kQuickStopOption{0x605A, 0};
inline constexpr Object kModeOfOperation{0x6060, 0};
inline constexpr Object kModeOfOperationDisplay{0x6061, 0};
inline constexpr Object kPositionActual{0x6064, 0};     ///< position, encoder counts
inline constexpr Object kTargetTorque{0x6071, 0};       ///< commanded torque, per mille of rated torque
inline constexpr Object kMaxTorque{0x6072, 0};          ///< limit of the torque, per mille of rated torque
inline constexpr Object kRatedTorque{0x6076, 0};        ///< mN m
inline constexpr Object kTorqueActual{0x6077, 0};       ///< torque made, per mille of rated torque
inline constexpr Object kEncoderIncrements{0x608F, 1};  ///< counts per motor revolution, here per joint revolution
inline constexpr Object kSupportedModes{0x6502, 0};     ///< bit 9 = cyclic synchronous torque
}  // namespace od

}  // namespace ligature::can
