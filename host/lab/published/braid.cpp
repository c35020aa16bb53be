// Overhand knots of n full turns: two strands braided over a length l, below an elastic loop, drawn tight with
// friction. The theory is that of Jawed et al. (docs/measurements/published.md#braid). Symbols: h radius of the thread,
// B its bending stiffness, F its tension, mu friction coefficient, l/n length of the braid per turn, k = 2 pi n / l,
// R radius of the loop where it leaves the braid, lambda length of the loop, e = l + lambda length of the thread less
// the distance of its ends.

#include <cmath>
#include <limits>
#include <numbers>

#include "host/lab/published/sliding_knot.hpp"

namespace ligature::published {
namespace {

constexpr double kPi = std::numbers::pi, kFriction = 0.119;
// n^2 h / e of all judged knots. They are far from tight: sqrt(h / R) is 0.13 for n = 2 and 0.065 for n = 4
constexpr double kShare = 0.005;

/// The knot as the theory has it at a given n^2 h / e.
struct Theory {
  double braid = 0.0, loop = 0.0;  ///< x = l / R and lambda / R
  /// The tension F, as n^2 F h^2 / (mu B)
  [[nodiscard]] double force() const { return std::pow(braid, 3) / (96.0 * std::sqrt(3.0) * kPi * kPi); }
};

/// Solves n^2 h / e = g / (8 sqrt(3) pi^2) by bisection for the elliptic modulus of the loop. Here g = x^2 / (x +
/// lambda / R); x and lambda / R are fields of Theory.
Theory theory_at(double share) {
  Theory found;
  double low = 1e-4, high = 1.0 - 1e-12;
  for (int k = 0; k < 100; ++k) {
    const double modulus = 0.5 * (low + high), m = modulus * modulus;
    const double K = std::comp_ellint_1(modulus), E = std::comp_ellint_2(modulus);
    found = {8.0 * (K - E) / m - 4.0 * K, 4.0 * K};
    const double g = found.braid * found.braid / (found.braid + found.loop);
    (g < 8.0 * std::sqrt(3.0) * kPi * kPi * share ? low : high) = modulus;
  }
  return found;
}

/// Draws the knot of n turns at n^2 h / e = `share`, and compares it with the theory.
void measure(const Subject& subject, int n, double share, Result& result) {
  const Theory theory = theory_at(share);
  const double excess = n * n / share, R_laid = excess / (theory.braid + theory.loop);
  const auto knot = draw_knot(subject, {n, kFriction, excess, theory.braid * R_laid, 150 + 50 * n});
  const double k = knot.wave_number, R = 1.0 / knot.exit_curvature;
  const double from_radius = 1.0 / std::sqrt(std::sqrt(12.0) * R);
  const double force = knot.tension * n * n / kFriction;
  std::string at = "n = " + std::to_string(n) + ": ";
  const bool judged = share == kShare && n >= 2;  // the theory does not apply to n = 1
  if (share != kShare) at += "n^2 h / e = " + std::to_string(share).substr(0, 7) + ": ";
  const auto add = [&](const char* what, double value, bool judge) {
    result.findings.push_back(judge ? validate::relative(at + what, 1.0, value, 0.10) : reported(at + what, value, ""));
  };
  add("F over eq. (5)", force / theory.force(), judged);
  add("l/n over 2 pi 12^(1/4) sqrt(h R)", from_radius / k, judged);
  add("F/(B k^2) over mu 2 pi n h k", knot.tension / (k * k * kFriction * 2.0 * kPi * n * k), judged);
  // The figure of l/n above puts the simulated knot's R into the theory's formula. If it is not 1, either l/n or R may
  // be the cause. So two more figures are reported: l/n with the R that the theory gives for this excess length
  // (R_laid), and the simulated R over R_laid.
  add("l/n, with the theory's R", 1.0 / std::sqrt(std::sqrt(12.0) * R_laid) / k, false);
  add("R over the theory's", R / R_laid, false);
  if (share == kShare) result.points.push_back({"n^2 F h^2 / (mu B)", double(n), theory.force(), force});
}

}  // namespace

Result braid(const Subject& subject) {
  Result result;
  for (const int n : subject.quick ? std::vector{2} : std::vector{1, 2, 3, 4}) measure(subject, n, kShare, result);
  if (subject.quick) return result;
  // Thinner threads for the same loop: does the radius approach that of the theory? Only reported.
  for (const double share : {0.5 * kShare, 0.25 * kShare}) measure(subject, 2, share, result);
  return result;
}

}  // namespace ligature::published
