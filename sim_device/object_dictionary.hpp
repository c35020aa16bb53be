#pragma once
// Values of a drive's objects, and the rules for changing them.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/can/object_table.hpp"
#include "protocol/can/sdo.hpp"
#include "sim_device/drive_constants.hpp"

namespace ligature::sim {

class ObjectDictionary {
 public:
  explicit ObjectDictionary(can::NodeId node, const DriveConstants& constants = {});

  /// Resets all objects, or only those of the communication profile (index below 0x2000), to their initial values.
  void reset() noexcept;
  void reset_communication() noexcept;

  /// Read by the drive itself. @pre the object exists (asserted).
  [[nodiscard]] std::int64_t value(can::Object object) const noexcept;
  /// Written by the drive itself, regardless of access rights. @pre the object exists (asserted).
  void set(can::Object object, std::int64_t value) noexcept;

  /// Handles one SDO request. @return the answer, possibly an abort; nothing if no answer is needed. Rules in addition
  /// to access rights and data length: a mapping may change only while its PDO is disabled, and only to the drive's
  /// pdo_map.hpp layout (else abort 0x06040041 of CiA 301); the mode must be cyclic synchronous torque or 0.
  [[nodiscard]] std::optional<can::Sdo> serve(const can::Sdo& request) noexcept;

  [[nodiscard]] bool is_pdo_on(can::Pdo pdo) const noexcept;

 private:
  [[nodiscard]] std::uint32_t refusal(const can::ObjectRow& row, std::int64_t value) const noexcept;
  [[nodiscard]] std::size_t row_of(can::Object object) const noexcept;

  DriveConstants constants_;
  can::ObjectTable table_;
  std::array<std::int64_t, 64> values_{};
};

}  // namespace ligature::sim
