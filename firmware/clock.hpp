#pragma once
// The clock of the two real-time contexts, as a concept: Linux's in the program, a number in tests.

#include <chrono>
#include <concepts>

namespace ligature {

using Nanoseconds = std::chrono::nanoseconds;  ///< time points are nanoseconds of one monotonic clock

// Version 14 of clang-format tears compound requirements apart.
// clang-format off
template <class C>
concept Clock = requires(C c, Nanoseconds at) {
  { c.now() } noexcept -> std::same_as<Nanoseconds>;
  { c.sleep_until(at) } noexcept;
  { c.worked() } noexcept -> std::same_as<Nanoseconds>;  // CPU time of this thread
};
// clang-format on

}  // namespace ligature
