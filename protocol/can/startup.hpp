#pragma once
// SDO writes that the master sends to a drive before NMT start, in order. The PDO mapping comes from pdo_map.hpp, so
// that a drive with factory settings gets the layout that the codec uses.

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/can/heartbeat.hpp"
#include "protocol/can/pdo_map.hpp"

namespace ligature::can {

struct SdoWrite {
  Object object;
  std::uint32_t value = 0;
  std::uint8_t bytes = 0;
};

/// Values of the device record for each drive.
struct DriveFacts {
  std::uint32_t rated_torque_mNm = profile::kRatedTorque_mNm;
  std::uint32_t counts_per_revolution = static_cast<std::uint32_t>(profile::kCountsPerRevolution);
  std::uint16_t max_torque_permille = static_cast<std::uint16_t>(profile::kMaxTorque_permille);
};

struct StartupTimes {
  /// After this time without an RPDO the drive sets its torque to zero.
  std::uint16_t rpdo_timeout_ms = profile::kDefaultRpdoTimeout_ms;
  /// After this time without the master's heartbeat the drive sets its torque to zero.
  std::uint16_t heartbeat_timeout_ms = profile::kDefaultHeartbeatTimeout_ms;
  std::uint16_t heartbeat_period_ms = profile::kDefaultHeartbeat_ms;  ///< period of the drive's own heartbeat
  DriveFacts drive{};
};

struct StartupPlan {
  std::array<SdoWrite, 32> writes{};
  std::size_t count = 0;

  constexpr void add(Object object, std::uint32_t value, std::uint8_t bytes) {
    writes[count++] = {object, value, bytes};
  }
  [[nodiscard]] constexpr const SdoWrite* begin() const noexcept { return writes.data(); }
  [[nodiscard]] constexpr const SdoWrite* end() const noexcept { return writes.data() + count; }
};

/// Disables a PDO, maps it, makes it synchronous, enables it again: the order that CiA 301 requires.
constexpr void add_pdo_setup(StartupPlan& plan, Pdo pdo, NodeId node) {
  const bool rpdo = pdo == Pdo::kRpdo1;
  const Object communication = rpdo ? od::kRpdo1CobId : od::kTpdo1CobId;
  const Object map = rpdo ? od::kRpdo1MapCount : od::kTpdo1MapCount;
  const std::uint32_t id = cob_id(rpdo ? Service::kRpdo1 : Service::kTpdo1, node).value;
  plan.add(communication, 0x8000'0000U | id, 4);
  plan.add(map, 0, 1);
  std::uint8_t entries = 0;
  for (const PdoField& f : layout_of(pdo, node)) plan.add(Object{map.index, ++entries}, mapping_word(f), 4);
  plan.add(map, entries, 1);
  plan.add(Object{communication.index, 2}, profile::kSynchronousEverySync, 1);
  plan.add(communication, id, 4);
}

[[nodiscard]] constexpr StartupPlan startup_plan(NodeId node, StartupTimes times = {}) {
  StartupPlan plan;
  add_pdo_setup(plan, Pdo::kTpdo1, node);
  add_pdo_setup(plan, Pdo::kRpdo1, node);
  plan.add(od::kRpdo1EventTimer, times.rpdo_timeout_ms, 2);
  plan.add(od::kConsumerHeartbeat, consumer_heartbeat_value(kMasterNode, times.heartbeat_timeout_ms), 4);
  plan.add(od::kProducerHeartbeat, times.heartbeat_period_ms, 2);
  plan.add(od::kAbortConnectionOption, 1, 2);
  plan.add(od::kMaxTorque, times.drive.max_torque_permille, 2);
  plan.add(od::kModeOfOperation, static_cast<std::uint32_t>(profile::kCyclicSynchronousTorque), 1);
  return plan;
}

static_assert(startup_plan(kElbow).count == 21);

}  // namespace ligature::can
