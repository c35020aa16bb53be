#pragma once
// A simulated CiA 402 drive as table [cia402] of a device record describes it.

#include <map>
#include <optional>
#include <utility>

#include "protocol/can/startup.hpp"
#include "protocol/device/device.hpp"
#include "sim_device/drive_node.hpp"

namespace ligature::sim {

/// Differs from our own drive, whose behaviour it has, in the objects that the record names: which of them exist, their
/// places, units and values, the number of PDOs, and where the buttons are. Further objects that the record writes to
/// exist too, and have no effect.
class ProfileNode final : public DriveNode {
 public:
  ProfileNode(can::NodeId id, const device::Device& device, const DriveConstants& constants);

  void power_on(Time now, std::vector<can::Frame>& out) override;
  void on_frame(const can::Frame& frame, Time now, const Sensed& sensed, std::vector<can::Frame>& out) override;

 private:
  using Key = std::pair<std::uint16_t, std::uint8_t>;
  struct Entry {
    std::uint32_t value = 0;
    std::uint8_t bytes = 4;
    bool is_constant = false;
  };

  void send_sample(const can::Tpdo1& sample, const Sensed& sensed, std::vector<can::Frame>& out) override;
  void add_entries();
  void add_pdo(bool rpdo, unsigned number);
  [[nodiscard]] bool has_buttons() const noexcept {
    return id() == can::NodeId{static_cast<std::uint8_t>(profile_.buttons.node)};
  }
  [[nodiscard]] bool is_missing(can::Object object) const noexcept;
  [[nodiscard]] std::optional<can::Sdo> answer(const can::Sdo& request);
  [[nodiscard]] std::uint32_t refusal(const can::Sdo& request, const Entry& entry) const;
  [[nodiscard]] std::uint32_t third_word() const noexcept;
  [[nodiscard]] std::uint32_t inputs_word() const noexcept;
  [[nodiscard]] bool sends_inputs() const;

  device::Cia402Profile profile_;
  std::uint32_t counts_, rated_torque_;  ///< in the units of the record's objects
  std::map<Key, Entry> entries_;         ///< the objects that our own drive lacks, and those with other values
};

}  // namespace ligature::sim
