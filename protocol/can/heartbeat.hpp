#pragma once
// Heartbeat: every node, including the master, reports its NMT state periodically; its absence is a fault.

#include <cstdint>
#include <optional>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::can {

enum class NmtState : std::uint8_t { kBootUp = 0x00, kStopped = 0x04, kOperational = 0x05, kPreOperational = 0x7F };

struct Heartbeat {
  NodeId node;
  NmtState state;
  friend constexpr bool operator==(const Heartbeat&, const Heartbeat&) = default;
};

[[nodiscard]] constexpr Frame encode(const Heartbeat& h) noexcept {
  return Frame{cob_id(Service::kHeartbeat, h.node).value, 1, {static_cast<std::uint8_t>(h.state)}};
}

/// Empty for another service, a wrong length or an undefined state.
[[nodiscard]] constexpr std::optional<Heartbeat> decode_heartbeat(const Frame& f) noexcept {
  const auto address = address_of(f.id);
  if (!address || address->service != Service::kHeartbeat || f.dlc != 1) return std::nullopt;
  const auto state = static_cast<NmtState>(f.data[0] & 0x7FU);  // bit 7 is the toggle bit of the older node guarding
  switch (state) {
    case NmtState::kBootUp:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational:
      return Heartbeat{address->node, state};
  }
  return std::nullopt;
}

/// Value of object 0x1016:01: the node to monitor and the longest allowed silence in ms; 0 ms switches monitoring off.
[[nodiscard]] constexpr std::uint32_t consumer_heartbeat_value(NodeId producer, std::uint16_t timeout_ms) noexcept {
  return (static_cast<std::uint32_t>(producer.value) << 16U) | timeout_ms;
}

static_assert(decode_heartbeat(encode(Heartbeat{kElbow, NmtState::kOperational}))->node == kElbow);

}  // namespace ligature::can
