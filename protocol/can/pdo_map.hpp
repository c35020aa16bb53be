#pragma once
// The table of process data: which object is at which position in which PDO. C++ codec, EDS, DBC and start-up SDOs are
// all derived from it; no other place defines an offset.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/can/device_profile.hpp"
#include "protocol/can/object.hpp"

namespace ligature::can {

enum class Pdo : std::uint8_t { kTpdo1, kRpdo1 };  ///< TPDO: from drive to controller; RPDO: from controller to drive
enum class Carriers : std::uint8_t { kEveryNode, kWithoutButtons, kWithButtons };

struct PdoField {
  Pdo pdo;
  Carriers carriers;  ///< nodes whose PDO has this field
  Object object;
  std::uint8_t bits;
  std::uint8_t offset_bits;  ///< counted from bit 0 of byte 0, little endian
  bool is_signed;
  std::string_view name;
  std::string_view unit;  ///< empty: bit field
};

inline constexpr std::array kPdoFields{
    PdoField{Pdo::kTpdo1, Carriers::kEveryNode, od::kStatusword, 16, 0, false, "Statusword", ""},
    PdoField{Pdo::kTpdo1, Carriers::kEveryNode, od::kPositionActual, 32, 16, true, "PositionActual", "counts"},
    PdoField{Pdo::kTpdo1, Carriers::kWithoutButtons, od::kTorqueActual, 16, 48, true, "TorqueActual", "permille"},
    PdoField{Pdo::kTpdo1, Carriers::kWithButtons, od::kStylusButtons, 16, 48, false, "StylusButtons", ""},
    PdoField{Pdo::kRpdo1, Carriers::kEveryNode, od::kControlword, 16, 0, false, "Controlword", ""},
    PdoField{Pdo::kRpdo1, Carriers::kEveryNode, od::kTargetTorque, 16, 16, true, "TargetTorque", "permille"},
};

[[nodiscard]] constexpr bool carries(const PdoField& f, NodeId node) noexcept {
  return f.carriers == Carriers::kEveryNode ||
         (f.carriers == Carriers::kWithButtons) == profile::has_stylus_buttons(node);
}

/// Fields of one PDO of one node, in mapping order.
struct PdoLayout {
  std::array<PdoField, kPdoFields.size()> fields{};
  std::size_t count = 0;

  [[nodiscard]] constexpr const PdoField* begin() const noexcept { return fields.data(); }
  [[nodiscard]] constexpr const PdoField* end() const noexcept { return fields.data() + count; }
};

[[nodiscard]] constexpr PdoLayout layout_of(Pdo pdo, NodeId node) noexcept {
  PdoLayout layout;
  for (const PdoField& f : kPdoFields) {
    if (f.pdo == pdo && carries(f, node)) layout.fields[layout.count++] = f;
  }
  return layout;
}

[[nodiscard]] constexpr std::uint8_t length_bytes(Pdo pdo, NodeId node) noexcept {
  unsigned bits = 0;
  for (const PdoField& f : layout_of(pdo, node)) bits += f.bits;
  return static_cast<std::uint8_t>(bits / 8);
}

/// The table row of one object; compile time only: for an object that is not mapped, compilation fails.
[[nodiscard]] consteval PdoField field_of(Pdo pdo, Object object) {
  for (const PdoField& f : kPdoFields) {
    if (f.pdo == pdo && f.object == object) return f;
  }
  throw "object is not in this PDO";  // NOLINT(bugprone-std-exception-baseclass): nothing is thrown at compile time
}

/// Mapping entry as stored in objects 0x1600 and 0x1A00: index, sub-index, length in bits.
[[nodiscard]] constexpr std::uint32_t mapping_word(const PdoField& f) noexcept {
  return (static_cast<std::uint32_t>(f.object.index) << 16U) | (static_cast<std::uint32_t>(f.object.sub) << 8U) |
         f.bits;
}

/// Checks that fields are packed as CANopen requires: no gap, no overlap, at most 8 bytes.
[[nodiscard]] constexpr bool is_packed(Pdo pdo, NodeId node) noexcept {
  unsigned next = 0;
  for (const PdoField& f : layout_of(pdo, node)) {
    if (f.offset_bits != next) return false;
    next += f.bits;
  }
  return next % 8 == 0 && next <= 64;
}

static_assert([] {
  for (const NodeId n : profile::kJointNodes) {
    if (!is_packed(Pdo::kTpdo1, n) || !is_packed(Pdo::kRpdo1, n)) return false;
    if (length_bytes(Pdo::kTpdo1, n) != 8 || length_bytes(Pdo::kRpdo1, n) != 4) return false;
  }
  return true;
}());

}  // namespace ligature::can
