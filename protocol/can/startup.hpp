#pragma once
// SDO writes that the master sends to a drive before NMT start, in order. They also set which object is at which
// position in the PDOs. These positions come from pdo_map.hpp, as those at which codec.hpp reads and writes the values.
// So a drive with factory settings needs no configuration by hand.

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

/// What makes a drive remove its torque when the controller falls silent.
enum class Watchdog : std::uint8_t { kRpdoTimer, kHeartbeat, kNone };

/// Where a hand's buttons are.
struct ButtonsSource {
  NodeId node = kElbow;
  Object object = od::kStylusButtons;
  std::uint8_t bits = 16;
  bool own_pdo = false;  ///< in a TPDO 2; false: in TPDO 1 instead of the torque

  [[nodiscard]] constexpr bool replace_torque_of(NodeId n) const noexcept { return !own_pdo && n == node; }
};

/// The drives as the device record describes them; without a record, our own.
struct DriveFacts {
  static constexpr std::size_t kMost = 16;
  Object rated_torque_object = od::kRatedTorque, counts_object = od::kEncoderIncrements;  ///< index 0: not there
  Object max_torque_object = od::kMaxTorque;                                              ///< index 0: not there
  /// Values that the first two objects must have, in their units
  std::uint32_t rated_torque = profile::kRatedTorque_mNm;
  std::uint32_t counts = static_cast<std::uint32_t>(profile::kCountsPerRevolution);
  std::uint16_t max_torque_permille = static_cast<std::uint16_t>(profile::kMaxTorque_permille);
  ButtonsSource buttons{};
  std::uint8_t pdos = 1;  ///< in each direction
  Watchdog watchdog = Watchdog::kRpdoTimer;
  std::array<SdoWrite, kMost> writes{};  ///< further writes; unused entries have index 0
  std::array<Object, kMost> optional{};  ///< may be missing; unused entries have index 0

  [[nodiscard]] constexpr bool may_lack(Object object) const noexcept {
    for (const Object& o : optional) {
      if (o.index != 0 && o == object) return true;
    }
    return false;
  }
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
  std::array<SdoWrite, 80> writes{};
  std::size_t count = 0;

  constexpr void add(Object object, std::uint32_t value, std::uint8_t bytes) {
    writes[count++] = {object, value, bytes};
  }
  [[nodiscard]] constexpr const SdoWrite* begin() const noexcept { return writes.data(); }
  [[nodiscard]] constexpr const SdoWrite* end() const noexcept { return writes.data() + count; }
};

/// Objects and identifier of PDO `number`, from 1, of a node.
struct PdoPlace {
  Object communication, map;
  std::uint32_t id = 0;
};
[[nodiscard]] constexpr PdoPlace pdo_place(bool rpdo, unsigned number, NodeId node) noexcept {
  const auto n = static_cast<std::uint16_t>(number - 1);
  const std::uint32_t first = cob_id(rpdo ? Service::kRpdo1 : Service::kTpdo1, node).value;
  return {{static_cast<std::uint16_t>((rpdo ? 0x1400 : 0x1800) + n), 1},
          {static_cast<std::uint16_t>((rpdo ? 0x1600 : 0x1A00) + n), 0},
          first + 0x100U * n};
}

inline constexpr std::uint32_t kPdoOff = 0x8000'0000;

/// Disables a PDO, maps it, makes it synchronous, enables it again: the order that CiA 301 requires.
constexpr void add_pdo_setup(StartupPlan& plan, const PdoPlace& pdo, const std::uint32_t* words, std::uint8_t count) {
  plan.add(pdo.communication, kPdoOff | pdo.id, 4);
  plan.add(pdo.map, 0, 1);
  for (std::uint8_t i = 0; i < count; ++i)
    plan.add(Object{pdo.map.index, static_cast<std::uint8_t>(i + 1)}, words[i], 4);
  plan.add(pdo.map, count, 1);
  plan.add(Object{pdo.communication.index, 2}, profile::kSynchronousEverySync, 1);
  plan.add(pdo.communication, pdo.id, 4);
}

[[nodiscard]] constexpr std::uint32_t mapping_word(const ButtonsSource& b) noexcept {
  return (static_cast<std::uint32_t>(b.object.index) << 16U) | (static_cast<std::uint32_t>(b.object.sub) << 8U) |
         b.bits;
}

/// Adds the mapping of TPDO 1 and RPDO 1: their objects in the order in which codec.hpp expects the values. Then that
/// of TPDO 2, if the buttons of this node have a TPDO of their own.
constexpr void add_pdos(StartupPlan& plan, NodeId node, const ButtonsSource& buttons) {
  const bool replaced = buttons.replace_torque_of(node);
  const std::uint32_t sample[] = {
      mapping_word(field_of(Pdo::kTpdo1, od::kStatusword)), mapping_word(field_of(Pdo::kTpdo1, od::kPositionActual)),
      replaced ? mapping_word(buttons) : mapping_word(field_of(Pdo::kTpdo1, od::kTorqueActual))};
  const std::uint32_t command[] = {mapping_word(field_of(Pdo::kRpdo1, od::kControlword)),
                                   mapping_word(field_of(Pdo::kRpdo1, od::kTargetTorque))};
  add_pdo_setup(plan, pdo_place(false, 1, node), sample, 3);
  add_pdo_setup(plan, pdo_place(true, 1, node), command, 2);
  if (!buttons.own_pdo || buttons.node != node) return;
  const std::uint32_t word = mapping_word(buttons);
  add_pdo_setup(plan, pdo_place(false, 2, node), &word, 1);
}

[[nodiscard]] constexpr StartupPlan startup_plan(NodeId node, const StartupTimes& times = {}) {
  StartupPlan plan;
  const DriveFacts& drive = times.drive;
  for (unsigned n = 1; drive.pdos > 1 && n <= drive.pdos; ++n) {  // PDOs that are on by default would fill the bus
    for (const bool rpdo : {false, true}) {
      const PdoPlace pdo = pdo_place(rpdo, n, node);
      plan.add(pdo.communication, kPdoOff | pdo.id, 4);
    }
  }
  for (const SdoWrite& w : drive.writes) {
    if (w.object.index != 0) plan.add(w.object, w.value, w.bytes);
  }
  add_pdos(plan, node, drive.buttons);
  if (drive.watchdog == Watchdog::kRpdoTimer) plan.add(od::kRpdo1EventTimer, times.rpdo_timeout_ms, 2);
  if (drive.watchdog != Watchdog::kNone)
    plan.add(od::kConsumerHeartbeat, consumer_heartbeat_value(kMasterNode, times.heartbeat_timeout_ms), 4);
  plan.add(od::kProducerHeartbeat, times.heartbeat_period_ms, 2);
  plan.add(od::kAbortConnectionOption, 1, 2);
  if (drive.max_torque_object.index != 0) plan.add(drive.max_torque_object, drive.max_torque_permille, 2);
  plan.add(od::kModeOfOperation, static_cast<std::uint32_t>(profile::kCyclicSynchronousTorque), 1);
  return plan;
}

static_assert(startup_plan(kElbow).count == 21);

}  // namespace ligature::can
