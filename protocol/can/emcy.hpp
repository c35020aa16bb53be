#pragma once
// EMCY, the error message of a drive: sent when an error occurs, and again when it is over (CiA 301).

#include <cstdint>
#include <optional>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::can {

namespace emcy {
inline constexpr std::uint16_t kNoError = 0x0000;        ///< all errors are reset
inline constexpr std::uint16_t kHeartbeatLost = 0x8130;  ///< life guard or heartbeat error
inline constexpr std::uint16_t kRpdoTimeout = 0x8250;    ///< RPDO event timer ran out
inline constexpr std::uint8_t kGenericBit = 1U << 0;     ///< bit of the error register 0x1001
inline constexpr std::uint8_t kCommunicationBit = 1U << 4;
}  // namespace emcy

struct Emergency {
  NodeId node;
  std::uint16_t code = emcy::kNoError;
  std::uint8_t error_register = 0;
  friend constexpr bool operator==(const Emergency&, const Emergency&) = default;
};

[[nodiscard]] constexpr Frame encode(const Emergency& e) noexcept {
  return Frame{cob_id(Service::kEmcy, e.node).value,
               8,
               {static_cast<std::uint8_t>(e.code & 0xFFU), static_cast<std::uint8_t>(e.code >> 8U), e.error_register}};
}

[[nodiscard]] constexpr std::optional<Emergency> decode_emergency(const Frame& f) noexcept {
  const auto address = address_of(f.id);
  if (!address || address->service != Service::kEmcy || f.dlc != 8) return std::nullopt;
  return Emergency{address->node, static_cast<std::uint16_t>(f.data[0] | (f.data[1] << 8U)), f.data[2]};
}

static_assert(decode_emergency(encode(Emergency{kWaist, emcy::kRpdoTimeout, 0x11})) ==
              Emergency{kWaist, emcy::kRpdoTimeout, 0x11});

}  // namespace ligature::can
