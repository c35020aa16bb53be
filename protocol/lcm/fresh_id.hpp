#pragma once
#include <cstdint>
#include <random>

namespace ligature::lcm_tools {

/// A random positive number that cannot be guessed, even with a wrong clock. Used as an identifier that no recording
/// can contain.
[[nodiscard]] inline std::int64_t fresh_id() {
  std::random_device device;
  constexpr std::uint64_t kPositive = ~(std::uint64_t{1} << 63U);
  return static_cast<std::int64_t>(((std::uint64_t{device()} << 32U | device()) & kPositive) | 1U);
}

}  // namespace ligature::lcm_tools
