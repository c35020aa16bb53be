#pragma once
// The CAN connection between a simulated hand and the firmware, on a simulated clock.

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
#include "sim_device/shelf_drives.hpp"

namespace ligature::lab {

using Nanoseconds = std::chrono::nanoseconds;

/// A frame is received when its last bit has been transmitted.
class DeviceBus final : public platform::CanBus {
 public:
  /// Length of the firmware interface's transmit queue, in frames, as on a rig (docs/deployment.md).
  static constexpr std::size_t kQueue = 8;

  /// @param record  names the drives
  DeviceBus(std::unique_ptr<sim::Intention> intention, const sim::Body& body, const device::Device& record,
            const Nanoseconds& now)
      : device(std::move(intention), now, body, true, sim::drives_of(record, body.drives, now)), now_(now) {}

  /// From now on loses this fraction (`share`) of the process data frames (PDOs) in both directions, 0 .. 1; equal
  /// seeds lose equal frames. SYNC, NMT, SDO and heartbeats are never lost.
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
  bool cut = false;  ///< true: the process of the hand was killed
  std::int64_t frames_lost = 0;

 private:
  [[nodiscard]] bool loses(const can::Frame& frame) noexcept;

  const Nanoseconds& now_;
  double lost_share_ = 0.0;
  std::mt19937_64 random_;
};

}  // namespace ligature::lab
