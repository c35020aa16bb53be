#pragma once
// CiA 402 drives of one hand: start-up by SDO (can_master.hpp), then the cyclic exchange (hand_link.hpp).

#include "firmware/platform/hand_drives.hpp"
#include "firmware/platform/hand_link.hpp"
#include "protocol/can/startup.hpp"

namespace ligature::platform {

class Cia402Drives final : public HandDrives {
 public:
  /// @param hand index; the two hands' heartbeats are sent in different periods, to spread the work
  Cia402Drives(CanBus& bus, const device::Device& device, int watchdog_ms, std::size_t hand);

  [[nodiscard]] std::optional<std::string> other_controller(BusWait& wait) override;
  [[nodiscard]] std::optional<std::string> configure(BusWait& wait) override;
  [[nodiscard]] std::vector<std::string> lacks() const override { return lacks_; }
  [[nodiscard]] std::vector<can::Frame> example_samples() const override;
  bool start() noexcept override;

  void request() noexcept override { link_.send_sync(); }
  void drain() noexcept override { link_.drain(); }
  [[nodiscard]] bool is_settled() const noexcept override { return link_.is_settled(); }
  [[nodiscard]] rt::HandReading reading() const noexcept override { return link_.reading(); }
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept override {
    return link_.write(command);
  }
  [[nodiscard]] rt::BusTime bus_time() const noexcept override { return time_; }
  std::optional<std::string> release(BusWait& wait) override;

 private:
  CanBus& bus_;
  can::StartupTimes times_;
  std::vector<std::string> lacks_;
  rt::BusTime time_;
  HandLink link_;
};

}  // namespace ligature::platform
