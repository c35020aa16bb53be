#pragma once
// Node ids, and the frame identifiers that CiA 301 derives from them ("predefined connection set"):
//  NMT 0x000 · SYNC 0x080 · EMCY 0x080+n · TPDO1 0x180+n · RPDO1 0x200+n · SDO 0x580+n (answer), 0x600+n (request)
//  · heartbeat 0x700+n.   On the bus the lower identifier has priority, so this list is in order of priority.

#include <compare>
#include <cstdint>
#include <optional>

#include "protocol/can/frame.hpp"

namespace ligature::can {

/// Node id on one bus, 1 .. 127. A type of its own, so that it cannot be confused with an index or identifier.
struct NodeId {
  std::uint8_t value = 0;
  friend constexpr auto operator<=>(const NodeId&, const NodeId&) = default;
};

/// Communication object identifier (COB-ID): the 11-bit frame identifier.
struct CobId {
  std::uint32_t value = 0;
  friend constexpr auto operator<=>(const CobId&, const CobId&) = default;
};

inline constexpr NodeId kWaist{1};
inline constexpr NodeId kShoulder{2};
inline constexpr NodeId kElbow{3};         ///< forearm drive; also reports the stylus buttons
inline constexpr NodeId kMasterNode{127};  ///< the controller, as sender of its heartbeat
inline constexpr NodeId kAllNodes{0};      ///< every node; only as the target of an NMT command
inline constexpr std::uint8_t kMaxNodeId = 127;

enum class Service : std::uint8_t { kNmt, kSync, kEmcy, kTpdo1, kRpdo1, kSdoResponse, kSdoRequest, kHeartbeat };

/// Base identifier of a service; the node id is added for all but NMT and SYNC.
[[nodiscard]] constexpr std::uint32_t base_id(Service s) noexcept {
  switch (s) {
    case Service::kNmt:
      return 0x000;
    case Service::kSync:  // identifier 0x080, with node id 0
    case Service::kEmcy:
      return 0x080;
    case Service::kTpdo1:
      return 0x180;
    case Service::kRpdo1:
      return 0x200;
    case Service::kSdoResponse:
      return 0x580;
    case Service::kSdoRequest:
      return 0x600;
    case Service::kHeartbeat:
      return 0x700;
  }
  return kMaxId;
}

[[nodiscard]] constexpr CobId cob_id(Service s, NodeId node) noexcept { return CobId{base_id(s) + node.value}; }

inline constexpr CobId kNmtCobId{base_id(Service::kNmt)};
inline constexpr CobId kSyncCobId{base_id(Service::kSync)};

/// Meaning of an identifier. NMT and SYNC have node id 0.
struct Address {
  Service service = Service::kNmt;
  NodeId node;
  friend constexpr bool operator==(const Address&, const Address&) = default;
};

/// Inverse of cob_id(); nothing for an identifier that this rig does not use (other PDOs, LSS, TIME).
[[nodiscard]] constexpr std::optional<Address> address_of(std::uint32_t id) noexcept {
  if (id == kNmtCobId.value) return Address{Service::kNmt, NodeId{0}};
  if (id == kSyncCobId.value) return Address{Service::kSync, NodeId{0}};
  for (const Service s : {Service::kEmcy, Service::kTpdo1, Service::kRpdo1, Service::kSdoResponse, Service::kSdoRequest,
                          Service::kHeartbeat}) {
    if (id > base_id(s) && id <= base_id(s) + kMaxNodeId) {
      return Address{s, NodeId{static_cast<std::uint8_t>(id - base_id(s))}};
    }
  }
  return std::nullopt;
}

static_assert(address_of(cob_id(Service::kRpdo1, kElbow).value) == Address{Service::kRpdo1, kElbow});
static_assert(address_of(0x080) == Address{Service::kSync, NodeId{0}} && !address_of(0x100) && !address_of(0x280));

}  // namespace ligature::can
