#pragma once
// The cable between a simulated hand and the firmware, on a clock that is a number.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "firmware/platform/can_bus.hpp"
#include "sim_device/fault_injector.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::lab {

using Nanoseconds = std::chrono::nanoseconds;

/// Frames come when their last bit has passed.
class DeviceBus final : public platform::CanBus {
 public:
  /// Frames that the firmware's interface has room for, as on a rig (docs/deployment.md).
  static constexpr std::size_t kQueue = 8;

  DeviceBus(std::unique_ptr<sim::Intention> intention, const sim::Body& body, const Nanoseconds& now)
      : device(std::move(intention), now, body), now_(now) {}

  /// From now on this share of the process data frames of either direction is lost, 0 .. 1; the same ones for the same
  /// seed. SYNC, NMT, SDO and heartbeats pass.
  void lose_frames(double share, std::uint64_t seed) noexcept {
    lost_share_ = share;
    random_.seed(seed);
  }

  bool send(const can::Frame& frame) noexcept override;
  platform::Receive receive(can::Frame& frame) noexcept override;
  [[nodiscard]] bool is_lost() const noexcept override { return cut; }
  [[nodiscard]] int descriptor() const noexcept override { return -1; }

  sim::HandDevice device;
  std::optional<sim::FaultInjector> faults;
  bool cut = false;  ///< the hand's process was killed
  std::int64_t frames_lost = 0;

 private:
  [[nodiscard]] bool loses(const can::Frame& frame) noexcept;

  const Nanoseconds& now_;
  double lost_share_ = 0.0;
  std::mt19937_64 random_;
};

}  // namespace ligature::lab
