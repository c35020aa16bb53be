#pragma once
// Frames of ODrive's CANSimple protocol that the controller sends and reads: identifier = node << 5 | command, little
// endian. A test holds them to a DBC that others wrote.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "firmware/rt/rig_io.hpp"
#include "protocol/can/remote.hpp"

namespace ligature::platform::odrive {

enum class Command : std::uint8_t {
  kGetVersion = 0x00,
  kHeartbeat = 0x01,
  kEstop = 0x02,
  kSetAxisState = 0x07,
  kEstimates = 0x09,
  kSetControllerMode = 0x0B,
  kSetInputPosition = 0x0C,
  kSetInputVelocity = 0x0D,
  kSetInputTorque = 0x0E,
  kSetLimits = 0x0F,
  kReboot = 0x16,
  kClearErrors = 0x18,
  kGetTorques = 0x1C,
};

inline constexpr std::uint8_t kIdle = 1, kClosedLoop = 8;  ///< states of an axis
inline constexpr std::uint32_t kWatchdogExpired = 0x0100'0000;
inline constexpr std::uint32_t kTorqueControl = 1, kPassthrough = 1;
inline constexpr unsigned kWordBytes = 8, kTorqueBytes = 4;  ///< the answers have 8 bytes

[[nodiscard]] constexpr std::uint32_t id_of(unsigned node, Command command) noexcept {
  return node << 5U | static_cast<std::uint32_t>(command);
}

namespace detail {
constexpr void put(can::Frame& f, std::size_t at, std::uint32_t value) noexcept {
  for (std::size_t i = 0; i < 4; ++i) f.data[at + i] = static_cast<std::uint8_t>(value >> (8U * i));
}
[[nodiscard]] constexpr std::uint32_t get(const can::Frame& f, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(f.data[at + i]) << (8U * i);
  return value;
}
}  // namespace detail

/// Asks for the data frame of this command.
[[nodiscard]] constexpr can::Frame ask(unsigned node, Command command) noexcept {
  return can::remote_frame(id_of(node, command), kWordBytes);
}
[[nodiscard]] constexpr can::Frame set_axis_state(unsigned node, std::uint8_t state) noexcept {
  can::Frame f{id_of(node, Command::kSetAxisState), 8, {}};
  detail::put(f, 0, state);
  return f;
}
[[nodiscard]] constexpr can::Frame set_torque_mode(unsigned node) noexcept {
  can::Frame f{id_of(node, Command::kSetControllerMode), 8, {}};
  detail::put(f, 0, kTorqueControl);
  detail::put(f, 4, kPassthrough);
  return f;
}
/// In torque mode set_position() and set_velocity() have no effect.
[[nodiscard]] constexpr can::Frame set_position(unsigned node, float rev) noexcept {
  can::Frame f{id_of(node, Command::kSetInputPosition), 8, {}};
  detail::put(f, 0, std::bit_cast<std::uint32_t>(rev));
  return f;
}
[[nodiscard]] constexpr can::Frame set_velocity(unsigned node, float rev_per_s) noexcept {
  can::Frame f{id_of(node, Command::kSetInputVelocity), 8, {}};
  detail::put(f, 0, std::bit_cast<std::uint32_t>(rev_per_s));
  return f;
}
/// Largest speed and current.
[[nodiscard]] constexpr can::Frame set_limits(unsigned node, float rev_per_s, float current_A) noexcept {
  can::Frame f{id_of(node, Command::kSetLimits), 8, {}};
  detail::put(f, 0, std::bit_cast<std::uint32_t>(rev_per_s));
  detail::put(f, 4, std::bit_cast<std::uint32_t>(current_A));
  return f;
}
/// Target torque, in 4 bytes. The published DBC declares 8, of which the last four mean nothing; three messages of 8
/// bytes would not fit into the period. Start-up tries whether the drive takes the short message.
[[nodiscard]] constexpr can::Frame set_torque(unsigned node, float torque_Nm) noexcept {
  can::Frame f{id_of(node, Command::kSetInputTorque), kTorqueBytes, {}};
  detail::put(f, 0, std::bit_cast<std::uint32_t>(torque_Nm));
  return f;
}
[[nodiscard]] constexpr can::Frame clear_errors(unsigned node) noexcept {
  return {id_of(node, Command::kClearErrors), 1, {}};
}
[[nodiscard]] constexpr can::Frame estop(unsigned node) noexcept { return {id_of(node, Command::kEstop), 0, {}}; }

struct Heartbeat {
  std::uint32_t error = 0;
  std::uint8_t state = 0;
};
[[nodiscard]] constexpr std::optional<Heartbeat> read_heartbeat(const can::Frame& f) noexcept {
  if (f.dlc < 5) return std::nullopt;
  return Heartbeat{detail::get(f, 0), f.data[4]};
}
/// The first number of an answer: the position in revolutions, or the torque that the drive aims at. Nothing for a
/// frame of another length or a number that is none.
[[nodiscard]] inline std::optional<float> read_number(const can::Frame& f) noexcept {
  const auto number = std::bit_cast<float>(detail::get(f, 0));
  if (f.dlc != kWordBytes || !std::isfinite(number)) return std::nullopt;
  return number;
}
/// Whether the drive's software is 0.6 or newer. Older ones have other error numbers, and do not tell their torque.
[[nodiscard]] constexpr bool is_supported(const can::Frame& version) noexcept {
  return version.dlc == kWordBytes && (version.data[4] > 0 || version.data[5] >= 6);
}

/// Node and command of a data frame of one of the three drives; nothing for other frames.
struct Address {
  std::size_t joint = 0;
  Command command{};
};
[[nodiscard]] constexpr std::optional<Address> address_of(std::uint32_t id) noexcept {
  const std::uint32_t node = id >> 5U;
  if (node < 1 || node > rt::kJoints) return std::nullopt;
  return Address{node - 1, static_cast<Command>(id & 0x1FU)};
}

inline constexpr std::uint32_t kEveryNode = 0x3F;  ///< all drives obey messages to it, from software 0.6.9 on

/// What a frame says of another controller; drives send neither commands nor remote frames.
[[nodiscard]] constexpr rt::Foreign foreign_kind(const can::Frame& f) noexcept {
  const std::uint32_t id = f.id & can::kMaxId;
  const bool is_to_all = id >> 5U == kEveryNode;
  if (!is_to_all && !address_of(id)) return rt::Foreign::kNone;
  if (can::is_remote(f)) return rt::Foreign::kBeat;
  switch (static_cast<Command>(id & 0x1FU)) {
    case Command::kSetInputPosition:
    case Command::kSetInputVelocity:
    case Command::kSetInputTorque:
      return rt::Foreign::kTorque;
    case Command::kSetAxisState:
    case Command::kEstop:
    case Command::kReboot:
    case Command::kClearErrors:
      return rt::Foreign::kNetwork;
    default:
      break;
  }
  constexpr std::uint32_t kOfDrives =  // 0x00, 0x01, 0x03, 0x05, 0x09, 0x14, 0x15, 0x17, 0x1C, 0x1D
      1U << 0x00U | 1U << 0x01U | 1U << 0x03U | 1U << 0x05U | 1U << 0x09U | 1U << 0x14U | 1U << 0x15U | 1U << 0x17U |
      1U << 0x1CU | 1U << 0x1DU;
  const bool is_of_drive = !is_to_all && (kOfDrives >> (id & 0x1FU) & 1U) != 0;
  if (is_of_drive && f.dlc == 0) return rt::Foreign::kBeat;  // a request, too
  return is_of_drive ? rt::Foreign::kNone : rt::Foreign::kObject;
}

}  // namespace ligature::platform::odrive
