#pragma once
// Recognises frames that only a controller sends. The bus sockets do not return the frames that this program has sent,
// so each such frame comes from another controller.

#include "firmware/rt/rig_io.hpp"
#include "protocol/can/cob_id.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::platform {

/// RPDO 2 to 4 count as well: a drive may be delivered with a mapping that obeys them.
[[nodiscard]] constexpr rt::Foreign foreign_kind(const can::Frame& frame) noexcept {
  constexpr std::uint32_t kLss = 0x7E5;  // layer setting services (CiA 305), which change node ids
  for (const std::uint32_t base : {0x300U, 0x400U, 0x500U}) {
    if (frame.id > base && frame.id <= base + can::kMaxNodeId) return rt::Foreign::kTorque;
  }
  if (frame.id == kLss) return rt::Foreign::kNetwork;
  const auto address = can::address_of(frame.id);
  if (!address) return rt::Foreign::kNone;
  switch (address->service) {
    case can::Service::kNmt:
      return rt::Foreign::kNetwork;
    case can::Service::kSync:
      return rt::Foreign::kBeat;
    case can::Service::kRpdo1:
      return rt::Foreign::kTorque;
    case can::Service::kSdoRequest:
      return rt::Foreign::kObject;
    case can::Service::kHeartbeat:
      return address->node == can::kMasterNode ? rt::Foreign::kBeat : rt::Foreign::kNone;
    case can::Service::kEmcy:
    case can::Service::kTpdo1:
    case can::Service::kSdoResponse:
      break;  // sent by drives
  }
  return rt::Foreign::kNone;
}

[[nodiscard]] constexpr const char* name(rt::Foreign kind) noexcept {
  switch (kind) {
    case rt::Foreign::kNone:
      break;
    case rt::Foreign::kTorque:
      return "RPDOs";
    case rt::Foreign::kBeat:
      return "SYNC or the controller's heartbeat";
    case rt::Foreign::kNetwork:
      return "NMT or LSS commands";
    case rt::Foreign::kObject:
      return "SDO requests";
  }
  return "nothing";
}

}  // namespace ligature::platform
