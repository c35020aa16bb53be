// A drum turns below a thread that is held: the ratio of the tensions on its two sides.

#include <cmath>
#include <numbers>

#include "host/lab/published/case.hpp"
#include "host/lab/validate/capstan.hpp"

namespace ligature::published {
namespace {

constexpr double kPi = std::numbers::pi, kSurface_m_per_s = 0.005;
constexpr int kPerTurn = 64;  // segments on the drum for each turn, as in the case capstan

}  // namespace

Result drum(const Subject& subject) {
  Result result;
  const std::vector<double> turns = subject.quick ? std::vector{0.5} : std::vector{0.25, 0.5, 1.0, 1.5};
  const std::vector<double> frictions = subject.quick ? std::vector{0.3} : std::vector{0.1, 0.3};
  for (const double mu : frictions) {
    for (const double turn : turns) {
      for (const double sense : {1.0, -1.0}) {  // the hand has the larger tension, or the smaller one
        const double angle = 2.0 * kPi * turn, truth = std::exp(sense * mu * angle);
        const int wrapped = static_cast<int>(std::lround(kPerTurn * turn));
        const double ratio =
            validate::tension_ratio(subject.rod(2 * wrapped + 1), mu, angle, wrapped, sense * kSurface_m_per_s);
        const std::string what = "mu = " + std::to_string(mu).substr(0, 3);
        const std::string to = sense > 0 ? "turns towards the load" : "turns to the hand";
        result.findings.push_back(validate::relative(
            what + ", " + std::to_string(turn).substr(0, 4) + " turns, " + to + ": T_hand/T_load", truth, ratio, 0.02));
        result.points.push_back({what + ", " + to, mu * angle, truth, ratio});
      }
    }
  }
  return result;
}

}  // namespace ligature::published
