#pragma once
// Proportions and rates from random draws with their 95 % intervals, formatted for the tables of docs/.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace ligature::test {

/// A proportion in percent with its 95 % Wilson interval.
[[nodiscard]] inline std::string share(int hits, int draws) {
  if (draws == 0) return "-";
  const double n = draws, p = hits / n, z = 1.96, z2 = z * z / n;
  const double middle = (p + 0.5 * z2) / (1.0 + z2),
               half = z * std::sqrt(p * (1.0 - p) / n + 0.25 * z2 / n) / (1.0 + z2);
  const double low = 100.0 * std::max(0.0, middle - half), high = 100.0 * std::min(1.0, middle + half);
  char text[64];
  if (hits == 0)
    std::snprintf(text, sizeof text, "0 (.. %.1f)", high);
  else
    std::snprintf(text, sizeof text, "%.1f (%.1f .. %.1f)", 100.0 * p, low, high);
  return text;
}

/// An event count with its 95 % Poisson interval (within a few percent of the exact interval).
[[nodiscard]] inline std::string rate(int events) {
  const auto edge = [](double k, double z) {  // Wilson and Hilferty approximation of a chi-squared quantile
    return k <= 0.0 ? 0.0 : k * std::pow(1.0 - 1.0 / (9.0 * k) + z / (3.0 * std::sqrt(k)), 3.0);
  };
  const double high = edge(events + 1.0, 1.96);
  char text[64];
  if (events == 0)
    std::snprintf(text, sizeof text, "0 (.. 3.7)");
  else
    std::snprintf(text, sizeof text, "%d (%.1f .. %.1f)", events, edge(events, -1.96), high);
  return text;
}

}  // namespace ligature::test
