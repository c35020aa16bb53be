#pragma once
// Encodes and decodes PDOs for both ends of the bus, from the table in pdo_map.hpp. Little endian, as in CANopen.
// Constant time, no allocation.

#include <cstdint>
#include <optional>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/can/pdo_map.hpp"

namespace ligature::can {

/// A drive's answer to SYNC. A node sends either torque or buttons; the other stays zero.
struct Tpdo1 {
  std::uint16_t statusword = 0;
  std::int32_t position_counts = 0;
  std::int16_t torque_permille = 0;
  std::uint16_t buttons = 0;  ///< bits: profile::kButton*, with_held(), with_life()
  friend constexpr bool operator==(const Tpdo1&, const Tpdo1&) = default;
};

/// Command to a drive; takes effect at the next SYNC.
struct Rpdo1 {
  std::uint16_t controlword = 0;
  std::int16_t target_torque_permille = 0;
  friend constexpr bool operator==(const Rpdo1&, const Rpdo1&) = default;
};

/// The 8 data bytes as one little-endian word.
[[nodiscard]] constexpr std::uint64_t data_word(const Frame& f) noexcept {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < 8; ++i) word |= static_cast<std::uint64_t>(f.data[i]) << (8 * i);
  return word;
}

constexpr void set_data_word(Frame& f, std::uint64_t word) noexcept {
  for (std::size_t i = 0; i < 8; ++i) f.data[i] = static_cast<std::uint8_t>(word >> (8 * i));
}

/// Writes the low f.bits of value at the field's position. @pre these bits of the frame are zero.
constexpr void put(Frame& frame, const PdoField& f, std::int64_t value) noexcept {
  const std::uint64_t mask = (std::uint64_t{1} << f.bits) - 1;
  set_data_word(frame, data_word(frame) | ((static_cast<std::uint64_t>(value) & mask) << f.offset_bits));
}

/// Reads the field, sign-extended if the table says so.
[[nodiscard]] constexpr std::int64_t get(const Frame& frame, const PdoField& f) noexcept {
  const std::uint64_t mask = (std::uint64_t{1} << f.bits) - 1;
  const std::uint64_t raw = (data_word(frame) >> f.offset_bits) & mask;
  const std::uint64_t sign = std::uint64_t{1} << (f.bits - 1);
  return f.is_signed && (raw & sign) != 0 ? static_cast<std::int64_t>(raw | ~mask) : static_cast<std::int64_t>(raw);
}

namespace field {
inline constexpr PdoField kStatusword = field_of(Pdo::kTpdo1, od::kStatusword);
inline constexpr PdoField kPosition = field_of(Pdo::kTpdo1, od::kPositionActual);
inline constexpr PdoField kTorqueActual = field_of(Pdo::kTpdo1, od::kTorqueActual);
inline constexpr PdoField kButtons = field_of(Pdo::kTpdo1, od::kStylusButtons);
inline constexpr PdoField kControlword = field_of(Pdo::kRpdo1, od::kControlword);
inline constexpr PdoField kTargetTorque = field_of(Pdo::kRpdo1, od::kTargetTorque);
}  // namespace field

[[nodiscard]] constexpr Frame encode(NodeId node, const Tpdo1& p) noexcept {
  Frame f{cob_id(Service::kTpdo1, node).value, length_bytes(Pdo::kTpdo1, node), {}};
  put(f, field::kStatusword, p.statusword);
  put(f, field::kPosition, p.position_counts);
  if (carries(field::kTorqueActual, node)) put(f, field::kTorqueActual, p.torque_permille);
  if (carries(field::kButtons, node)) put(f, field::kButtons, p.buttons);
  return f;
}

[[nodiscard]] constexpr Frame encode(NodeId node, const Rpdo1& p) noexcept {
  Frame f{cob_id(Service::kRpdo1, node).value, length_bytes(Pdo::kRpdo1, node), {}};
  put(f, field::kControlword, p.controlword);
  put(f, field::kTargetTorque, p.target_torque_permille);
  return f;
}

/// Empty if the frame is not this node's TPDO1, or its length differs from the map.
/// @param buttons whether this node's TPDO1 has the buttons instead of the torque
[[nodiscard]] constexpr std::optional<Tpdo1> decode_tpdo1(NodeId node, const Frame& f, bool buttons) noexcept {
  if (f.id != cob_id(Service::kTpdo1, node).value || f.dlc != length_bytes(Pdo::kTpdo1, node)) return std::nullopt;
  Tpdo1 p;
  p.statusword = static_cast<std::uint16_t>(get(f, field::kStatusword));
  p.position_counts = static_cast<std::int32_t>(get(f, field::kPosition));
  if (buttons)
    p.buttons = static_cast<std::uint16_t>(get(f, field::kButtons));
  else
    p.torque_permille = static_cast<std::int16_t>(get(f, field::kTorqueActual));
  return p;
}
[[nodiscard]] constexpr std::optional<Tpdo1> decode_tpdo1(NodeId node, const Frame& f) noexcept {
  return decode_tpdo1(node, f, carries(field::kButtons, node));
}

/// Empty if the frame is not this node's RPDO1, or its length differs from the map.
[[nodiscard]] constexpr std::optional<Rpdo1> decode_rpdo1(NodeId node, const Frame& f) noexcept {
  if (f.id != cob_id(Service::kRpdo1, node).value || f.dlc != length_bytes(Pdo::kRpdo1, node)) return std::nullopt;
  return Rpdo1{static_cast<std::uint16_t>(get(f, field::kControlword)),
               static_cast<std::int16_t>(get(f, field::kTargetTorque))};
}

static_assert(decode_rpdo1(kElbow, encode(kElbow, Rpdo1{0x000F, -3000})) == Rpdo1{0x000F, -3000});
static_assert(encode(kWaist, Tpdo1{0x1237, -2, -1, 0}).data ==
              decltype(Frame::data){0x37, 0x12, 0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF});

}  // namespace ligature::can
