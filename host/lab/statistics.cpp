#include "host/lab/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::lab {

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  const auto rank = [&](double share) {
    const auto k = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
    const auto at = values.begin() + std::max<std::ptrdiff_t>(k, 0);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  return {rank(0.5), rank(0.99), *std::max_element(values.begin(), values.end())};
}

}  // namespace ligature::lab
