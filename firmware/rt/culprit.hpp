#pragma once
// The part of the rig that a fault is about, or that a rig in the state OFF or CALIBRATE waits for.

#include <cstdint>

namespace ligature::rt {

struct Culprit {
  std::int8_t hand = -1;    ///< 0 left, 1 right, -1: neither, or both
  std::int8_t joint = -1;   ///< whose drive or encoder it is: 0 waist, 1 shoulder, 2 forearm, 3 button module; -1: none
  std::uint32_t error = 0;  ///< error code that the drive sent; 0: none
  bool operator==(const Culprit&) const = default;
};

}  // namespace ligature::rt
