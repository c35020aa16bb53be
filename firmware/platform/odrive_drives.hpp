#pragma once
// ODrive drives of one hand: start-up, then the cyclic exchange (odrive_link.hpp). CANSimple cannot read settings back,
// so start-up tries those that safety depends on: the mode and the watchdog.

#include "firmware/platform/hand_drives.hpp"
#include "firmware/platform/odrive_link.hpp"

namespace ligature::platform {

/// What ODrive drives cannot promise, one line each.
[[nodiscard]] std::vector<std::string> odrive_lacks(const device::OdriveProfile& profile);

class OdriveDrives final : public HandDrives {
 public:
  /// @param watchdog_ms longest silence of the controller after which torque may remain
  OdriveDrives(CanBus& bus, const device::Device& device, int watchdog_ms);

  [[nodiscard]] std::optional<std::string> other_controller(BusWait& wait) override;
  [[nodiscard]] std::optional<std::string> configure(BusWait& wait) override;
  [[nodiscard]] std::vector<std::string> lacks() const override { return odrive_lacks(profile_); }
  [[nodiscard]] std::vector<can::Frame> example_samples() const override;
  bool start() noexcept override { return true; }

  void request() noexcept override { link_.request(); }
  void drain() noexcept override { link_.drain(); }
  [[nodiscard]] bool is_settled() const noexcept override { return link_.is_settled(); }
  [[nodiscard]] rt::HandReading reading() const noexcept override { return link_.reading(); }
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept override {
    return link_.write(command);
  }
  [[nodiscard]] rt::BusTime bus_time() const noexcept override;
  std::optional<std::string> release(BusWait& wait) override;

 private:
  using Node = OdriveLink::Node;
  /// What is sent in each period of a wait.
  struct Traffic {
    std::optional<float> torque_Nm{};  ///< feeds the drives' watchdog
    bool requests = false;             ///< for samples, as in operation
    bool targets = false;              ///< requests for the torque that the drives aim at
  };

  template <class Condition>
  bool wait_until(BusWait& wait, Nanoseconds at_most, const Traffic& traffic, Condition condition);
  template <class Condition>
  std::optional<std::string> expect(BusWait& wait, Nanoseconds at_most, const Traffic& traffic, Condition is_good,
                                    const std::string& complaint);
  [[nodiscard]] std::optional<std::string> bus_complaint() const;
  [[nodiscard]] std::string name_of(const Node& node) const;
  [[nodiscard]] std::optional<std::string> set_up(BusWait& wait);
  [[nodiscard]] std::optional<std::string> try_torque(BusWait& wait, float torque_Nm);
  [[nodiscard]] std::optional<std::string> try_mode(BusWait& wait);
  [[nodiscard]] std::optional<std::string> try_watchdog(BusWait& wait);
  [[nodiscard]] std::optional<std::string> clear_errors(BusWait& wait);
  [[nodiscard]] std::optional<std::string> switch_off(BusWait& wait);
  [[nodiscard]] bool send_idle(BusWait& wait);
  void send_traffic(const Traffic& traffic) noexcept;
  void pause(BusWait& wait);
  template <class MakeFrame>
  void to_all(MakeFrame make_frame) noexcept;
  [[nodiscard]] Nanoseconds beats(int count) const noexcept;

  device::OdriveProfile profile_;
  int watchdog_ms_;
  CanBus& bus_;
  float trial_torque_Nm_;
  OdriveLink link_;
};

}  // namespace ligature::platform
