#pragma once
// The values behind a drive's objects, and who may change them when.

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

  /// All objects, or those of the communication profile (index below 0x2000) only, back to their initial values.
  void reset() noexcept;
  void reset_communication() noexcept;

  /// Reads from inside the drive. @pre the object exists (asserted).
  [[nodiscard]] std::int64_t value(can::Object object) const noexcept;
  /// Writes from inside the drive, access rights aside. @pre the object exists (asserted).
  void set(can::Object object, std::int64_t value) noexcept;

  /// Serves one request of the bus: the answer, an abort included; nothing for what needs no answer.
  /// Rules beyond access and length: a mapping may change only while its PDO is off and then only to what the drive can
  /// map (its pdo_map.hpp layout, CiA 301's abort 0x06040041 otherwise); the mode must be cyclic synchronous torque or
  /// 0.
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
