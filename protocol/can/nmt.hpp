#pragma once
// NMT: the master's commands that set the communication state of nodes (CiA 301). And SYNC, which starts each period.

#include <cstdint>
#include <optional>

#include "protocol/can/cob_id.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::can {

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kEnterPreOperational = 0x80,
  kResetNode = 0x81,           ///< like switching power off and on
  kResetCommunication = 0x82,  ///< sets communication objects to their defaults; a drive fault stays latched
};

struct NmtMessage {
  NmtCommand command;
  NodeId target;  ///< kAllNodes or one node
  [[nodiscard]] constexpr bool is_for(NodeId node) const noexcept { return target == kAllNodes || target == node; }
};

[[nodiscard]] constexpr Frame encode_nmt(NmtCommand command, NodeId target = kAllNodes) noexcept {
  return Frame{kNmtCobId.value, 2, {static_cast<std::uint8_t>(command), target.value}};
}

[[nodiscard]] constexpr std::optional<NmtMessage> decode_nmt(const Frame& f) noexcept {
  if (f.id != kNmtCobId.value || f.dlc != 2) return std::nullopt;
  const auto command = static_cast<NmtCommand>(f.data[0]);
  switch (command) {
    case NmtCommand::kStart:
    case NmtCommand::kStop:
    case NmtCommand::kEnterPreOperational:
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      return NmtMessage{command, NodeId{f.data[1]}};
  }
  return std::nullopt;
}

/// SYNC without a counter: no data. Every drive samples its inputs and applies its last RPDO when the frame ends.
[[nodiscard]] constexpr Frame sync_frame() noexcept { return Frame{kSyncCobId.value, 0, {}}; }
[[nodiscard]] constexpr bool is_sync(const Frame& f) noexcept { return f.id == kSyncCobId.value; }

}  // namespace ligature::can
