#pragma once
// Concept of the clock of the two real-time threads (control loop and suture physics): Linux's monotonic clock in the
// program, simulated time in tests.

#include <chrono>
#include <concepts>

namespace ligature {

using Nanoseconds = std::chrono::nanoseconds;  ///< time since the epoch of one monotonic clock

// clang-format 14 splits compound requirements over several lines.
// clang-format off
template <class C>
concept Clock = requires(C c, Nanoseconds at) {
  { c.now() } noexcept -> std::same_as<Nanoseconds>;
  { c.sleep_until(at) } noexcept;
  { c.worked() } noexcept -> std::same_as<Nanoseconds>;  // CPU time of this thread
};
// clang-format on

}  // namespace ligature
