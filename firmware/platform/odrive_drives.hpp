#pragma once
// ODrive drives of one hand: start-up, then the cyclic exchange (odrive_link.hpp). CANSimple cannot read settings back,
// so start-up tries what safety depends on: the watchdog.

#include "firmware/platform/hand_drives.hpp"
#include "firmware/platform/odrive_link.hpp"

namespace ligature::platform {

/// What ODrive drives cannot promise, one line each.
[[nodiscard]] std::vector<std::string> odrive_lacks(const device::OdriveProfile& profile);

class OdriveDrives final : public HandDrives {
 public:
  OdriveDrives(CanBus& bus, const device::Device& device);

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
  void release(BusWait& wait) override;

 private:
  using Node = OdriveLink::Node;
  enum class Feed : std::uint8_t { kTorque, kNothing };

  template <class Condition>
  bool wait_until(BusWait& wait, Nanoseconds at_most, Feed feed, Condition condition);
  template <class Condition>
  std::optional<std::string> expect(BusWait& wait, Nanoseconds at_most, Feed feed, Condition is_good,
                                    const std::string& complaint);
  std::optional<std::string> try_watchdog(BusWait& wait);
  void to_all(can::Frame (*frame)(unsigned node)) noexcept;
  [[nodiscard]] Nanoseconds beats(int count) const noexcept;

  device::OdriveProfile profile_;
  CanBus& bus_;
  OdriveLink link_;
};

}  // namespace ligature::platform
