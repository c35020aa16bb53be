// Capstan: a thread slips round a peg; the ratio of the tensions on its two sides.

#include "host/lab/validate/capstan.hpp"

#include <cmath>
#include <numbers>

#include "host/lab/published/case.hpp"
#include "host/lab/validate/cases.hpp"

namespace ligature::published {
namespace {

constexpr double kPi = std::numbers::pi;

/// Segments on the peg for each turn. The polygon makes the exponent mu theta of the tension ratio (mu friction, theta
/// angle on the peg) wrong by phi^2 / 6 = 0.16 %, where phi is the angle between two segments.
constexpr int kPerTurn = 64;

}  // namespace

Result capstan(const Subject& subject) {
  Result result;
  const std::vector<double> turns = subject.quick ? std::vector{0.5, 1.0} : std::vector{0.25, 0.5, 1.0, 1.5, 2.0};
  const std::vector<double> frictions = subject.quick ? std::vector{0.3} : std::vector{0.1, 0.3};
  for (const double mu : frictions) {
    for (const double turn : turns) {
      const double angle = 2.0 * kPi * turn, truth = std::exp(mu * angle);
      const int wrapped = static_cast<int>(std::lround(kPerTurn * turn));
      const double ratio = validate::tension_ratio(subject.rod(2 * wrapped + 1), mu, angle, wrapped);
      const std::string what = "mu = " + std::to_string(mu).substr(0, 3);
      result.findings.push_back(validate::relative(
          "peg, " + what + ", " + std::to_string(turn).substr(0, 4) + " turns: T_hi/T_lo", truth, ratio, 0.02));
      result.points.push_back({"peg, " + what, mu * angle, truth, ratio});
    }
  }
  return result;
}

}  // namespace ligature::published
