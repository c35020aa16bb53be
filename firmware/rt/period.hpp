#pragma once
// The control period of the whole rig.

#include <chrono>

namespace ligature::rt {

inline constexpr std::chrono::nanoseconds kPeriod = std::chrono::milliseconds(1);
inline constexpr double kPeriod_s = std::chrono::duration<double>(kPeriod).count();

}  // namespace ligature::rt
