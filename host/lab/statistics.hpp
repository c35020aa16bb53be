#pragma once

#include <vector>

namespace ligature::lab {

struct Spread {
  double median = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Order statistics (nearest rank); zeros for an empty vector.
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// Largest and mean of a non-negative quantity, one value at a time.
struct MaxMean {
  double max = 0.0;
  double sum = 0.0;
  long count = 0;

  void add(double v) noexcept {
    max = v > max ? v : max;
    sum += v;
    ++count;
  }
  [[nodiscard]] double mean() const noexcept { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

}  // namespace ligature::lab
