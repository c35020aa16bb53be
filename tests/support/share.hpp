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

/// The upper or lower edge of the exact 95 % interval of a Poisson distribution's mean, after this many events.
[[nodiscard]] inline double poisson_edge(int events, bool upper) {
  if (events == 0 && !upper) return 0.0;
  double low = 0.0, high = events + 10.0 * std::sqrt(events + 1.0);
  for (int i = 0; i < 60; ++i) {
    const double mean = 0.5 * (low + high);
    double below = 0.0;  // probability of fewer events; upper: of at most as many
    for (int k = 0; k < events + (upper ? 1 : 0); ++k)
      below += std::exp(k * std::log(mean) - mean - std::lgamma(k + 1));
    (below > (upper ? 0.025 : 0.975) ? low : high) = mean;
  }
  return high;
}

/// Events in `hours` with their exact 95 % interval, from the number of events in `watched` hours.
[[nodiscard]] inline std::string rate(int events, double watched = 1.0, double hours = 1.0) {
  const auto number = [&](double count) {
    char text[32];
    const double scaled = count * hours / watched;
    std::snprintf(text, sizeof text, scaled < 100.0 ? "%.2g" : "%.0f", scaled);
    return std::string(text);
  };
  const std::string high = number(poisson_edge(events, true));
  if (events == 0) return "0 (.. " + high + ")";
  return number(events) + " (" + number(poisson_edge(events, false)) + " .. " + high + ")";
}

}  // namespace ligature::test
