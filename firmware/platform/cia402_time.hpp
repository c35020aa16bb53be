#pragma once
// Bus time of CiA 402 drives on a classic CAN bus at 1 Mbit/s.

#include "firmware/rt/bus_time.hpp"
#include "protocol/can/bit_time.hpp"

namespace ligature::platform {

/// Bus time of the frames of a tick: SYNC, three TPDOs of 8 bytes, three RPDOs of 4 bytes; also a TPDO with the buttons
/// if buttons_bytes > 0, and a heartbeat if `beats`.
[[nodiscard]] constexpr rt::BusTime cia402_time(unsigned buttons_bytes = 0, bool beats = false) noexcept {
  const auto ns = [](unsigned bits) { return std::chrono::nanoseconds(can::bits_to_ns(bits)); };
  const unsigned fewest = can::min_frame_bits(0) + 3 * can::min_frame_bits(8);
  const unsigned most = can::max_frame_bits(0) + 3 * can::max_frame_bits(8);
  const unsigned torques = 3 * can::max_frame_bits(4) + (beats ? can::max_frame_bits(1) : 0);
  if (buttons_bytes == 0) return {ns(fewest), ns(most), ns(torques)};
  return {ns(fewest + can::min_frame_bits(buttons_bytes)), ns(most + can::max_frame_bits(buttons_bytes)), ns(torques)};
}
static_assert(cia402_time().samples_latest == std::chrono::microseconds(460) &&
              cia402_time().most_work() == std::chrono::microseconds(255) &&
              cia402_time().longest_wait() == std::chrono::microseconds(680));

}  // namespace ligature::platform
