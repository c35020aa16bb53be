// A sliding knot that is tied round a post: at which friction it holds after the hands let go, and how its strength
// depends on the pre-tension.

#include <cmath>
#include <limits>

#include "host/lab/published/case.hpp"
#include "host/lab/published/post_knot.hpp"

namespace ligature::published {
namespace {

constexpr double kTying_N = 5.0, kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kHolds = 0.01;  // a knot that carries less than this share of the pre-tension has sprung open

/// Sums for the straight line through points and for their correlation.
struct Fit {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  void add(double a, double b) { n += 1.0, x += a, y += b, xx += a * a, xy += a * b, yy += b * b; }
  [[nodiscard]] double slope() const { return (n * xy - x * y) / (n * xx - x * x); }
  [[nodiscard]] double correlation() const { return (n * xy - x * y) / std::sqrt((n * xx - x * x) * (n * yy - y * y)); }
};

void sweep_friction(const Subject& subject, Result& result) {
  const auto frictions = subject.quick ? std::vector{0.05, 0.3} : std::vector{0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35};
  for (const double mu : frictions) {
    const auto r = tie_on_post(subject, {.friction = mu, .tying_N = kTying_N});
    const bool holds = r.tied && r.strength_N >= kHolds * kTying_N, expected = mu > 0.12;
    const std::string what = "friction " + std::to_string(mu).substr(0, 4) + ": ";
    result.findings.push_back(validate::absolute(what + "holds after letting go", expected, holds, 0.0, "(1: yes)"));
    result.findings.push_back(reported(what + "strength over pre-tension", r.strength_N / kTying_N, ""));
    result.points.push_back({"strength over pre-tension", mu, kNone, r.strength_N / kTying_N});
  }
}

void sweep_tension(const Subject& subject, bool sets, Result& result) {
  const std::string thread = sets ? "bends that set: " : "elastic: ";
  Fit power, normal;
  for (const double tying_N : {1.0, 2.0, 3.5, 5.0, 7.0}) {
    const auto r = tie_on_post(subject, {.friction = 0.3, .tying_N = tying_N, .sets = sets});
    power.add(std::log(tying_N), std::log(r.strength_N));
    normal.add(r.normal_N, r.strength_N);
  }
  const std::string exponent = thread + "exponent of strength against pre-tension";
  result.findings.push_back(sets ? validate::within(exponent, 1.0, 10.0, power.slope())
                                 : reported(exponent, power.slope(), ""));
  result.findings.push_back(
      validate::within(thread + "correlation of strength and normal force left", 0.0, 1.0, normal.correlation()));
}

}  // namespace

Result post(const Subject& subject) {
  Result result;
  sweep_friction(subject, result);
  if (subject.quick) return result;
  for (const bool sets : {false, true}) sweep_tension(subject, sets, result);
  return result;
}

}  // namespace ligature::published
