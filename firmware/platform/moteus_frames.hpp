#pragma once
// CAN-FD frames of moteus drives that the controller sends and reads. The identifier is source << 8 | destination, with
// bit 15 if the drive shall answer; the controller is 0, the drives are 1 to 3. The bytes are sub-frames that write,
// read or tell registers. A test holds them to the maker's own Python package, byte for byte.

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/rt/rig_io.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::platform::moteus {

enum class Mode : std::uint8_t { kStopped = 0, kPosition = 10, kTimeout = 11 };
/// 2 to 4: the drive measures its current sensors before it switches on.
[[nodiscard]] constexpr bool is_preparing(std::uint8_t mode) noexcept { return mode >= 2 && mode <= 4; }
[[nodiscard]] constexpr bool is(std::uint8_t mode, Mode which) noexcept {
  return mode == static_cast<std::uint8_t>(which);
}

/// Registers that are read one after the other, one in each period: what the drive was last commanded, and whether it
/// knows its position. They change the length of nothing, and tell which request an answer belongs to.
enum class Extra : std::uint8_t { kHome, kKpScale, kKdScale, kMaxTorque, kWatchdog, kIlimitScale };
inline constexpr std::size_t kExtras = 6;
inline constexpr std::array<std::uint8_t, kExtras> kExtraRegister{0x0C, 0x23, 0x24, 0x25, 0x27, 0x2B};
[[nodiscard]] constexpr std::uint8_t register_of(Extra extra) noexcept {
  return kExtraRegister[static_cast<std::size_t>(extra)];
}
inline constexpr float kHomeUnknown = 0.0F;  ///< the position counts from power-on

inline constexpr std::uint32_t kButtonsId = 0x400;  ///< node 4 to the controller: the module of the buttons
inline constexpr std::uint8_t kQueryBytes = 12, kReplyBytes = 24, kTorqueBytes = 32;
inline constexpr std::uint8_t kNop = 0x50;

namespace detail {
/// Appends sub-frames to a frame.
class Writer {
 public:
  constexpr explicit Writer(std::uint32_t id) noexcept : frame_{id, 0, {}, can::Format::kFdFast} {}
  constexpr Writer& bytes(std::initializer_list<std::uint8_t> list) noexcept {
    for (const std::uint8_t b : list) frame_.data[frame_.dlc++] = b;
    return *this;
  }
  constexpr Writer& number(std::uint8_t reg, float value) noexcept {  // writes one register as a float
    bytes({0x0D, reg});
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned i = 0; i < 4; ++i) frame_.data[frame_.dlc++] = static_cast<std::uint8_t>(bits >> (8U * i));
    return *this;
  }
  [[nodiscard]] constexpr can::Frame done() noexcept {
    const std::uint8_t length = can::fd_length(frame_.dlc);
    while (frame_.dlc < length) frame_.data[frame_.dlc++] = kNop;
    return frame_;
  }

 private:
  can::Frame frame_;
};
}  // namespace detail

/// Asks for mode, position, torque, fault and one more register.
[[nodiscard]] constexpr can::Frame query(unsigned node, Extra extra) noexcept {
  return detail::Writer(can::kExtendedBit | 0x8000U | node)
      .bytes({0x11, 0x00, 0x1D, 0x01, 0x1D, 0x03, 0x11, 0x0F, 0x1D, register_of(extra)})
      .done();
}

/// What a command for a torque says besides it.
struct Limits {
  float max_torque_Nm = 0.0F;
  float watchdog_s = 0.0F;
};
/// Only this torque: position mode at no position, with all gains zero. The mode comes first, because it resets all
/// that the drive was commanded before.
[[nodiscard]] constexpr can::Frame torque(unsigned node, float torque_Nm, const Limits& limits) noexcept {
  return detail::Writer(node)
      .bytes({0x01, 0x00, static_cast<std::uint8_t>(Mode::kPosition), 0x01, 0x20, 0x80})  // 0x80: no number
      .number(0x22, torque_Nm)
      .bytes({0x02, 0x23, 0x00, 0x00})
      .number(0x25, limits.max_torque_Nm)
      .number(0x27, limits.watchdog_s)
      .bytes({0x01, 0x2B, 0x00})
      .done();
}
[[nodiscard]] constexpr can::Frame stop(unsigned node) noexcept {
  return detail::Writer(node).bytes({0x01, 0x00, static_cast<std::uint8_t>(Mode::kStopped)}).done();
}

struct Reply {
  std::uint8_t mode = 0;
  float position_rev = 0.0F, torque_Nm = 0.0F;
  std::uint8_t fault = 0;
  Extra extra{};
  float extra_value = 0.0F;
};
/// 96 to 103 tell what limits the torque; other numbers than 0 are faults.
[[nodiscard]] constexpr bool is_limit(std::uint8_t fault) noexcept { return fault >= 96 && fault <= 103; }

/// The answer to query(); nothing for a frame of another form. Its numbers may be NaN.
[[nodiscard]] inline std::optional<Reply> read_reply(const can::Frame& f) noexcept {
  const auto has = [&f](std::size_t at, std::uint8_t kind, std::uint8_t reg) {
    return f.data[at] == kind && f.data[at + 1] == reg;
  };
  const auto number = [&f](std::size_t at) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(f.data[at + i]) << (8U * i);
    return std::bit_cast<float>(bits);
  };
  if (f.dlc != kReplyBytes || !has(0, 0x21, 0x00) || !has(3, 0x2D, 0x01) || !has(9, 0x2D, 0x03) || !has(15, 0x21, 0x0F))
    return std::nullopt;
  for (std::size_t i = 0; i < kExtras; ++i) {
    if (!has(18, 0x2D, kExtraRegister[i])) continue;
    return Reply{f.data[2], number(5), number(11), f.data[17], static_cast<Extra>(i), number(20)};
  }
  return std::nullopt;
}

/// The joint that sent this frame to the controller; none for a remote frame or one with 29 bits.
[[nodiscard]] constexpr std::optional<std::size_t> joint_of(const can::Frame& f) noexcept {
  const std::uint32_t node = f.id >> 8U;
  if ((f.id & 0xFFU) != 0 || node < 1 || node > rt::kJoints) return std::nullopt;
  return node - 1;
}

/// What a frame to a drive, or to all of them (0x7F), says of another controller: drives send to the controller only.
[[nodiscard]] constexpr rt::Foreign foreign_kind(const can::Frame& f) noexcept {
  const std::uint32_t to = f.id & 0x7FU;
  if (to != 0x7F && (to < 1 || to > rt::kJoints)) return rt::Foreign::kNone;
  if (f.dlc >= 3 && f.data[0] == 0x01 && f.data[1] == 0x00 && f.data[2] == 0x00) return rt::Foreign::kNetwork;
  if (f.dlc == 0 || (f.data[0] & 0xF0U) == 0x10U) return rt::Foreign::kBeat;
  return f.data[0] < 0x10U ? rt::Foreign::kTorque : rt::Foreign::kObject;
}

}  // namespace ligature::platform::moteus
