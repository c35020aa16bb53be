#pragma once
#include <cstdint>
#include <random>

namespace ligature::host {

/// Never the same twice, whatever the clock says, not to be guessed, and above 0: a recording cannot know it.
[[nodiscard]] inline std::int64_t fresh_id() {
  std::random_device device;
  constexpr std::uint64_t kPositive = ~(std::uint64_t{1} << 63U);
  return static_cast<std::int64_t>(((std::uint64_t{device()} << 32U | device()) & kPositive) | 1U);
}

}  // namespace ligature::host
