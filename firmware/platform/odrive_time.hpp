#pragma once
// Bus time of ODrive drives on a classic CAN bus at 1 Mbit/s.

#include "firmware/platform/answer_set.hpp"
#include "firmware/platform/odrive_frames.hpp"
#include "firmware/rt/bus_time.hpp"
#include "protocol/can/bit_time.hpp"

namespace ligature::platform {

/// Three remote frames, three answers of 8 bytes, the answer of the button module, and at most one heartbeat. Nothing
/// has to arrive before the next request: a torque acts when it arrives. What is still on the bus then delays the
/// request; all frames of a period take less than a period, so the bus catches up.
[[nodiscard]] constexpr rt::BusTime odrive_time() noexcept {
  const auto ns = [](unsigned bits) { return std::chrono::nanoseconds(can::bits_to_ns(bits)); };
  const unsigned fewest = 3 * (can::min_frame_bits(0) + can::min_frame_bits(odrive::kWordBytes)) +
                          can::min_frame_bits(ButtonModule::kBytes);
  const unsigned most = 3 * (can::max_frame_bits(0) + can::max_frame_bits(odrive::kWordBytes)) +
                        can::max_frame_bits(ButtonModule::kBytes) + can::max_frame_bits(odrive::kWordBytes);
  return {ns(fewest), ns(most), ns(0)};
}
/// Longest time of the three torques on the bus.
[[nodiscard]] constexpr std::chrono::nanoseconds odrive_torques_time() noexcept {
  return std::chrono::nanoseconds(can::bits_to_ns(3 * can::max_frame_bits(odrive::kTorqueBytes)));
}

}  // namespace ligature::platform
