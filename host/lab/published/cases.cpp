#include <cmath>
#include <limits>

#include "host/lab/published/case.hpp"

namespace ligature::published {
namespace {

constexpr Case kCases[] = {
    // friction round a bar
    {"capstan", "T_hi = T_lo exp(mu theta) round a peg and round a drum that turns", "Euler (1769), Eytelwein (1808)",
     "mu theta", "T_hi / T_lo", capstan},
};

}  // namespace

std::span<const Case> all_cases() { return kCases; }

Finding reported(std::string what, double measured, std::string unit) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {
      std::move(what), kNone, measured, std::isnan(measured) ? measured : 0.0, std::numeric_limits<double>::infinity(),
      std::move(unit)};
}

bool is_judged(const Finding& f) noexcept { return std::isfinite(f.tolerance); }

}  // namespace ligature::published
