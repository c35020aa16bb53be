#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace ligature::host {

/// The nearest-rank percentile: the smallest sample that is >= at least `percent` % of all samples. It is always a
/// measured value, never an interpolation; percent = 100 gives the largest.
/// @param samples reordered by the call; may be empty (result 0). @param percent 0 < percent <= 100.
/// Cost: O(n).
[[nodiscard]] inline std::int32_t percentile(std::span<std::int32_t> samples, double percent) {
  if (samples.empty()) return 0;
  const double rank = std::ceil(percent / 100.0 * static_cast<double>(samples.size()) - 1e-9);
  const auto index = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(rank) - 1, 0, std::ssize(samples) - 1);
  std::nth_element(samples.begin(), samples.begin() + index, samples.end());
  return samples[static_cast<std::size_t>(index)];
}

}  // namespace ligature::host
