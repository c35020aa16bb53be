#include "sim_device/object_dictionary.hpp"

#include <cassert>

namespace ligature::sim {
namespace {

using can::DataType;
namespace od = can::od;

/// Converts an SDO's raw value to the object's type.
std::int64_t widen(std::uint32_t raw, DataType type) noexcept {
  switch (type) {
    case DataType::kI8:
      return static_cast<std::int8_t>(raw);
    case DataType::kI16:
      return static_cast<std::int16_t>(raw);
    case DataType::kI32:
      return static_cast<std::int32_t>(raw);
    case DataType::kU8:
    case DataType::kU16:
    case DataType::kU32:
      return raw;
  }
  return raw;
}

std::uint32_t narrow(std::int64_t value, DataType type) noexcept {
  const auto raw = static_cast<std::uint32_t>(static_cast<std::uint64_t>(value));
  const unsigned bits = 8U * can::bytes_of(type);
  return bits == 32 ? raw : raw & ((1U << bits) - 1U);
}

bool is_mapping(std::uint16_t index) noexcept {
  return index == od::kRpdo1MapCount.index || index == od::kTpdo1MapCount.index;
}

}  // namespace

ObjectDictionary::ObjectDictionary(can::NodeId node, const DriveConstants& constants)
    : constants_(constants), table_(can::object_table(node)) {
  table_.rows[row_of(od::kRatedTorque)].initial = constants.rated_torque_mNm;
  table_.rows[row_of(od::kEncoderIncrements)].initial = constants.counts_per_revolution;
  table_.rows[row_of(od::kMaxTorque)].initial = constants.max_torque_permille;
  reset();
}

void ObjectDictionary::reset() noexcept {
  for (std::size_t i = 0; i < table_.count; ++i) values_[i] = table_.rows[i].initial;
}

void ObjectDictionary::reset_communication() noexcept {
  for (std::size_t i = 0; i < table_.count; ++i) {
    if (table_.rows[i].object.index < 0x2000) values_[i] = table_.rows[i].initial;
  }
}

std::size_t ObjectDictionary::row_of(can::Object object) const noexcept {
  const can::ObjectRow* row = table_.find(object);
  assert(row != nullptr);
  return static_cast<std::size_t>(row - table_.begin());
}

std::int64_t ObjectDictionary::value(can::Object object) const noexcept { return values_[row_of(object)]; }
void ObjectDictionary::set(can::Object object, std::int64_t value) noexcept { values_[row_of(object)] = value; }

bool ObjectDictionary::is_pdo_on(can::Pdo pdo) const noexcept {
  const bool rpdo = pdo == can::Pdo::kRpdo1;
  const bool valid = (value(rpdo ? od::kRpdo1CobId : od::kTpdo1CobId) & 0x8000'0000) == 0;
  return valid && value(rpdo ? od::kRpdo1MapCount : od::kTpdo1MapCount) != 0;
}

std::uint32_t ObjectDictionary::refusal(const can::ObjectRow& row, std::int64_t value) const noexcept {
  const can::Object o = row.object;
  if (is_mapping(o.index)) {
    const can::Object communication = o.index == od::kRpdo1MapCount.index ? od::kRpdo1CobId : od::kTpdo1CobId;
    if ((this->value(communication) & 0x8000'0000) == 0) return can::sdo_abort::kWrongDeviceState;
    const bool clears = o.sub == 0 && value == 0;
    if (!clears && value != row.initial) return can::sdo_abort::kCannotBeMapped;
  }
  if (o == od::kControlword || o == od::kTargetTorque) return can::sdo_abort::kWrongDeviceState;
  const bool cob_id = o == od::kRpdo1CobId || o == od::kTpdo1CobId;
  if (cob_id && (value & 0x7FFF'FFFF) != row.initial) return can::sdo_abort::kValueOutOfRange;
  const bool type = o == od::kRpdo1TransmissionType || o == od::kTpdo1TransmissionType;
  if (type && value != can::profile::kSynchronousEverySync) return can::sdo_abort::kValueOutOfRange;
  if (o == od::kModeOfOperation && value != 0 && value != can::profile::kCyclicSynchronousTorque) {
    return can::sdo_abort::kValueOutOfRange;
  }
  if (o == od::kMaxTorque && value > constants_.max_torque_permille) return can::sdo_abort::kValueOutOfRange;
  return 0;
}

std::optional<can::Sdo> ObjectDictionary::serve(const can::Sdo& request) noexcept {
  using can::SdoKind;
  const auto abort = [&](std::uint32_t code) {
    return can::Sdo{SdoKind::kAbort, request.node, request.object, code, 0};
  };
  if (request.kind == SdoKind::kAbort) return std::nullopt;  // no transfer is in progress that it could abort
  if (request.kind != SdoKind::kWrite && request.kind != SdoKind::kRead) return abort(can::sdo_abort::kUnknownCommand);

  const can::ObjectRow* row = table_.find(request.object);
  if (row == nullptr) {
    for (const can::ObjectRow& r : table_) {
      if (r.object.index == request.object.index) return abort(can::sdo_abort::kNoSuchSubIndex);
    }
    return abort(can::sdo_abort::kNoSuchObject);
  }
  const std::uint8_t bytes = can::bytes_of(row->type);
  if (request.kind == SdoKind::kRead) {
    return can::Sdo{SdoKind::kValue, request.node, request.object, narrow(value(request.object), row->type), bytes};
  }
  if (row->access != can::Access::kReadWrite) return abort(can::sdo_abort::kReadOnly);
  if (request.bytes != bytes) return abort(can::sdo_abort::kWrongLength);
  const std::int64_t wanted = widen(request.value, row->type);
  if (const std::uint32_t code = refusal(*row, wanted); code != 0) return abort(code);
  set(request.object, wanted);
  return can::Sdo{SdoKind::kWritten, request.node, request.object, 0, 0};
}

}  // namespace ligature::sim
