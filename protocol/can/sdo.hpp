#pragma once
// SDO, expedited transfers only (at most 4 bytes): reads and writes a drive's objects at start-up (CiA 301). In CiA
// terms download means writing to the drive, upload reading from it.

#include <cstdint>
#include <optional>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/can/object.hpp"

namespace ligature::can {

namespace sdo_abort {
inline constexpr std::uint32_t kUnknownCommand = 0x05040001;
inline constexpr std::uint32_t kReadOnly = 0x06010002;
inline constexpr std::uint32_t kNoSuchObject = 0x06020000;
inline constexpr std::uint32_t kCannotBeMapped = 0x06040041;
inline constexpr std::uint32_t kWrongLength = 0x06070010;
inline constexpr std::uint32_t kNoSuchSubIndex = 0x06090011;
inline constexpr std::uint32_t kValueOutOfRange = 0x06090030;
inline constexpr std::uint32_t kWrongDeviceState = 0x08000022;
}  // namespace sdo_abort

enum class SdoKind : std::uint8_t {
  kWrite,       // master -> drive
  kRead,        // master -> drive
  kWritten,     // drive -> master
  kValue,       // drive -> master
  kAbort,       // either direction; value is the abort code
  kUnsupported  // segmented or block transfer
};

struct Sdo {
  SdoKind kind = SdoKind::kUnsupported;
  NodeId node;
  Object object;
  std::uint32_t value = 0;
  std::uint8_t bytes = 0;  ///< size of `value`: 1 .. 4 for kWrite and kValue, else 0
  friend constexpr bool operator==(const Sdo&, const Sdo&) = default;
};

[[nodiscard]] constexpr std::uint8_t sdo_specifier(SdoKind kind, std::uint8_t bytes) noexcept {
  const auto unused = static_cast<std::uint8_t>((4U - bytes) << 2U);  // expedited, size indicated
  switch (kind) {
    case SdoKind::kWrite:
      return static_cast<std::uint8_t>(0x23U | unused);
    case SdoKind::kRead:
      return 0x40;
    case SdoKind::kWritten:
      return 0x60;
    case SdoKind::kValue:
      return static_cast<std::uint8_t>(0x43U | unused);
    case SdoKind::kAbort:
      return 0x80;
    case SdoKind::kUnsupported:
      break;
  }
  return 0;
}

/// Frame of a transfer. to_drive sets the direction of an abort; other kinds have a fixed direction.
[[nodiscard]] constexpr Frame encode(const Sdo& s, bool to_drive = false) noexcept {
  const bool request = s.kind == SdoKind::kWrite || s.kind == SdoKind::kRead || (s.kind == SdoKind::kAbort && to_drive);
  Frame f{cob_id(request ? Service::kSdoRequest : Service::kSdoResponse, s.node).value, 8, {}};
  f.data[0] = sdo_specifier(s.kind, s.bytes);
  f.data[1] = static_cast<std::uint8_t>(s.object.index & 0xFFU);
  f.data[2] = static_cast<std::uint8_t>(s.object.index >> 8U);
  f.data[3] = s.object.sub;
  for (std::size_t i = 0; i < 4; ++i) f.data[4 + i] = static_cast<std::uint8_t>(s.value >> (8 * i));
  return f;
}

[[nodiscard]] constexpr Frame sdo_write(NodeId node, Object object, std::uint32_t value, std::uint8_t bytes) noexcept {
  return encode(Sdo{SdoKind::kWrite, node, object, value, bytes});
}
[[nodiscard]] constexpr Frame sdo_read(NodeId node, Object object) noexcept {
  return encode(Sdo{SdoKind::kRead, node, object, 0, 0});
}

/// Decodes both directions; empty if the frame is not an SDO.
[[nodiscard]] constexpr std::optional<Sdo> decode_sdo(const Frame& f) noexcept {
  const auto address = address_of(f.id);
  if (!address || f.dlc != 8) return std::nullopt;
  if (address->service != Service::kSdoRequest && address->service != Service::kSdoResponse) return std::nullopt;
  const bool request = address->service == Service::kSdoRequest;
  const std::uint8_t specifier = f.data[0];
  Sdo s{SdoKind::kUnsupported, address->node,
        Object{static_cast<std::uint16_t>(f.data[1] | (f.data[2] << 8U)), f.data[3]}, 0, 0};
  for (std::size_t i = 0; i < 4; ++i) s.value |= static_cast<std::uint32_t>(f.data[4 + i]) << (8 * i);

  const bool carries_data = (specifier & 0xE3U) == (request ? 0x23U : 0x43U);
  if (specifier == 0x80) {
    s.kind = SdoKind::kAbort;
  } else if (carries_data) {
    s.kind = request ? SdoKind::kWrite : SdoKind::kValue;
    s.bytes = static_cast<std::uint8_t>(4U - ((specifier >> 2U) & 3U));
    if (s.bytes < 4) s.value &= (1U << (8U * s.bytes)) - 1U;
  } else if (specifier == (request ? 0x40 : 0x60)) {
    s.kind = request ? SdoKind::kRead : SdoKind::kWritten;
    s.value = 0;
  }
  return s;
}

static_assert(decode_sdo(sdo_write(kWaist, od::kModeOfOperation, 10, 1)) ==
              Sdo{SdoKind::kWrite, kWaist, od::kModeOfOperation, 10, 1});
static_assert(sdo_write(kWaist, od::kModeOfOperation, 10, 1).data[0] == 0x2F);

}  // namespace ligature::can
