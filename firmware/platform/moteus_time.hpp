#pragma once
// Bus time of moteus drives on a CAN-FD bus with 1 and 5 Mbit/s.

#include "firmware/platform/answer_set.hpp"
#include "firmware/platform/moteus_frames.hpp"
#include "firmware/rt/bus_time.hpp"
#include "protocol/can/fd_time.hpp"

namespace ligature::platform {

/// Three requests, three answers, and the answer of the button module, which is a classic frame at most. Nothing has to
/// arrive before the next request: a torque acts when it arrives. All frames of a period take less than a period.
[[nodiscard]] constexpr rt::BusTime moteus_time() noexcept {
  const auto ns = [](std::int64_t query, std::int64_t reply, unsigned button_bits) {
    return std::chrono::nanoseconds(3 * (query + reply) + can::bits_to_ns(button_bits));
  };
  return {ns(can::min_fd_bits(moteus::kQueryBytes, true).ns(), can::min_fd_bits(moteus::kReplyBytes, false).ns(),
             can::min_frame_bits(ButtonModule::kBytes)),
          ns(can::max_fd_bits(moteus::kQueryBytes, true).ns(), can::max_fd_bits(moteus::kReplyBytes, false).ns(),
             can::max_frame_bits(ButtonModule::kBytes)),
          std::chrono::nanoseconds(0)};
}
/// Longest time of the three torques on the bus.
[[nodiscard]] constexpr std::chrono::nanoseconds moteus_torques_time() noexcept {
  return std::chrono::nanoseconds(3 * can::max_fd_bits(moteus::kTorqueBytes, false).ns());
}

}  // namespace ligature::platform
