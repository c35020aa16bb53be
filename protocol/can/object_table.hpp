#pragma once
// The object dictionary of a drive as a table: served by the simulated drive and exported as EDS.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/can/heartbeat.hpp"
#include "protocol/can/pdo_map.hpp"

namespace ligature::can {

/// Data type codes of CiA 301.
enum class DataType : std::uint8_t { kI8 = 0x02, kI16 = 0x03, kI32 = 0x04, kU8 = 0x05, kU16 = 0x06, kU32 = 0x07 };
enum class Access : std::uint8_t { kConst, kReadOnly, kReadWrite };

[[nodiscard]] constexpr std::uint8_t bytes_of(DataType t) noexcept {
  switch (t) {
    case DataType::kI8:
    case DataType::kU8:
      return 1;
    case DataType::kI16:
    case DataType::kU16:
      return 2;
    case DataType::kI32:
    case DataType::kU32:
      return 4;
  }
  return 0;
}

[[nodiscard]] constexpr bool is_signed(DataType t) noexcept {
  return t == DataType::kI8 || t == DataType::kI16 || t == DataType::kI32;
}

struct ObjectRow {
  Object object;
  DataType type = DataType::kU8;
  Access access = Access::kReadOnly;
  std::int64_t initial = 0;
  std::string_view name;      ///< name of the entry
  std::string_view group;     ///< name of the whole index; empty for an index without sub-indices
  bool adds_node_id = false;  ///< initial contains the node id ($NODEID in the EDS)
};

struct ObjectTable {
  std::array<ObjectRow, 64> rows{};  // NOLINT(bugprone-invalid-enum-default-initialization): ObjectRow sets its type
  std::size_t count = 0;

  constexpr void add(const ObjectRow& row) { rows[count++] = row; }
  [[nodiscard]] constexpr const ObjectRow* begin() const noexcept { return rows.data(); }
  [[nodiscard]] constexpr const ObjectRow* end() const noexcept { return rows.data() + count; }
  [[nodiscard]] constexpr const ObjectRow* find(Object o) const noexcept {
    for (const ObjectRow& r : *this) {
      if (r.object == o) return &r;
    }
    return nullptr;
  }
};

/// Communication and mapping parameters of one PDO with factory defaults: mapped as in pdo_map.hpp, synchronous.
constexpr void add_pdo_objects(ObjectTable& table, Pdo pdo, NodeId node) {
  const bool rpdo = pdo == Pdo::kRpdo1;
  const std::uint16_t communication = rpdo ? 0x1400 : 0x1800;
  const std::uint16_t mapping = rpdo ? 0x1600 : 0x1A00;
  const std::string_view group = rpdo ? "RPDO1 communication" : "TPDO1 communication";
  const std::string_view map_group = rpdo ? "RPDO1 mapping" : "TPDO1 mapping";
  const std::uint32_t id = cob_id(rpdo ? Service::kRpdo1 : Service::kTpdo1, node).value;
  table.add({{communication, 0}, DataType::kU8, Access::kConst, rpdo ? 5 : 2, "Highest sub-index", group});
  table.add({{communication, 1}, DataType::kU32, Access::kReadWrite, id, "COB-ID", group, true});
  table.add({{communication, 2},
             DataType::kU8,
             Access::kReadWrite,
             profile::kSynchronousEverySync,
             "Transmission type",
             group});
  if (rpdo) table.add({{communication, 5}, DataType::kU16, Access::kReadWrite, 0, "Event timer", group});
  const PdoLayout layout = layout_of(pdo, node);
  table.add({{mapping, 0},
             DataType::kU8,
             Access::kReadWrite,
             static_cast<std::int64_t>(layout.count),
             "Number of mapped objects",
             map_group});
  std::uint8_t sub = 0;
  for (const PdoField& f : layout) {
    table.add({{mapping, ++sub}, DataType::kU32, Access::kReadWrite, mapping_word(f), f.name, map_group});
  }
}

/// All objects of the drive with this node id.
[[nodiscard]] constexpr ObjectTable object_table(NodeId node) {
  ObjectTable t;
  t.add({od::kDeviceType, DataType::kU32, Access::kConst, 0x0002'0192, "Device type", ""});  // CiA 402, servo drive
  t.add({od::kErrorRegister, DataType::kU8, Access::kReadOnly, 0, "Error register", ""});
  t.add({{0x1016, 0}, DataType::kU8, Access::kConst, 1, "Highest sub-index", "Consumer heartbeat time"});
  t.add({od::kConsumerHeartbeat, DataType::kU32, Access::kReadWrite, 0, "Master heartbeat", "Consumer heartbeat time"});
  t.add({od::kProducerHeartbeat, DataType::kU16, Access::kReadWrite, 0, "Producer heartbeat time", ""});
  t.add({{0x1018, 0}, DataType::kU8, Access::kConst, 1, "Highest sub-index", "Identity"});
  t.add({od::kVendorId, DataType::kU32, Access::kConst, 0, "Vendor-ID", "Identity"});  // 0: none assigned
  add_pdo_objects(t, Pdo::kRpdo1, node);
  add_pdo_objects(t, Pdo::kTpdo1, node);
  if (profile::has_stylus_buttons(node)) {
    t.add({{0x2100, 0}, DataType::kU8, Access::kConst, 1, "Highest sub-index", "Stylus"});
    t.add({od::kStylusButtons, DataType::kU16, Access::kReadOnly, 0, "StylusButtons", "Stylus"});
  }
  t.add({od::kAbortConnectionOption, DataType::kI16, Access::kReadWrite, 1, "Abort connection option code", ""});
  t.add({od::kErrorCode, DataType::kU16, Access::kReadOnly, 0, "Error code", ""});
  t.add({od::kControlword, DataType::kU16, Access::kReadWrite, 0, "Controlword", ""});
  t.add({od::kStatusword, DataType::kU16, Access::kReadOnly, 0, "Statusword", ""});
  t.add({od::kQuickStopOption, DataType::kI16, Access::kReadWrite, 0, "Quick stop option code", ""});
  t.add({od::kModeOfOperation, DataType::kI8, Access::kReadWrite, 0, "Modes of operation", ""});
  t.add({od::kModeOfOperationDisplay, DataType::kI8, Access::kReadOnly, 0, "Modes of operation display", ""});
  t.add({od::kPositionActual, DataType::kI32, Access::kReadOnly, 0, "PositionActual", ""});
  t.add({od::kTargetTorque, DataType::kI16, Access::kReadWrite, 0, "TargetTorque", ""});
  t.add({od::kMaxTorque, DataType::kU16, Access::kReadWrite, profile::kMaxTorque_permille, "Max torque", ""});
  t.add({od::kRatedTorque, DataType::kU32, Access::kReadOnly, profile::kRatedTorque_mNm, "Motor rated torque", ""});
  t.add({od::kTorqueActual, DataType::kI16, Access::kReadOnly, 0, "TorqueActual", ""});
  t.add({{0x608F, 0}, DataType::kU8, Access::kConst, 2, "Highest sub-index", "Position encoder resolution"});
  t.add({od::kEncoderIncrements, DataType::kU32, Access::kConst, profile::kCountsPerRevolution, "Encoder increments",
         "Position encoder resolution"});
  t.add({{0x608F, 2}, DataType::kU32, Access::kConst, 1, "Motor revolutions", "Position encoder resolution"});
  t.add({od::kSupportedModes, DataType::kU32, Access::kConst, 1U << 9U, "Supported drive modes", ""});
  return t;
}

static_assert([] {  // every object in the PDO map exists, with the same width and sign
  for (const NodeId node : profile::kJointNodes) {
    const ObjectTable table = object_table(node);
    for (const PdoField& f : kPdoFields) {
      if (!carries(f, node)) continue;
      const ObjectRow* row = table.find(f.object);
      if (row == nullptr || 8 * bytes_of(row->type) != f.bits || is_signed(row->type) != f.is_signed) return false;
    }
  }
  return true;
}());

}  // namespace ligature::can
