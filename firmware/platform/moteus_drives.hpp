#pragma once
// moteus drives of one hand: start-up, then the cyclic exchange (moteus_link.hpp). Every command carries all that
// safety depends on, and the drives tell it back. Start-up tries what no register tells: the watchdog.

#include "firmware/platform/hand_drives.hpp"
#include "firmware/platform/moteus_link.hpp"

namespace ligature::platform {

/// What moteus drives cannot promise, one line each.
[[nodiscard]] std::vector<std::string> moteus_lacks();

class MoteusDrives final : public HandDrives {
 public:
  /// @param watchdog_ms as the drives are told in every command
  MoteusDrives(CanBus& bus, const device::Device& device, int watchdog_ms)
      : watchdog_(std::chrono::milliseconds(watchdog_ms)), bus_(bus), link_(bus, device, watchdog_ms) {}

  [[nodiscard]] std::optional<std::string> other_controller(BusWait& wait) override;
  [[nodiscard]] std::optional<std::string> configure(BusWait& wait) override;
  [[nodiscard]] std::vector<std::string> lacks() const override { return moteus_lacks(); }
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
  std::optional<std::string> release(BusWait& wait) override { return switch_off(wait); }

 private:
  using Node = MoteusLink::Node;

  template <class Condition>
  bool run(BusWait& wait, Nanoseconds at_most, std::optional<rt::DriveRequest> request, Condition condition);
  template <class Condition>
  std::optional<std::string> expect(BusWait& wait, std::optional<rt::DriveRequest> request, Condition is_good,
                                    const std::string& complaint);
  [[nodiscard]] std::optional<std::string> bus_complaint() const;
  [[nodiscard]] std::string name_of(const Node& node) const;
  [[nodiscard]] std::optional<std::string> set_up(BusWait& wait);
  [[nodiscard]] std::optional<std::string> try_watchdog(BusWait& wait);
  [[nodiscard]] std::optional<std::string> switch_off(BusWait& wait);

  Nanoseconds watchdog_;
  CanBus& bus_;
  MoteusLink link_;
};

}  // namespace ligature::platform
