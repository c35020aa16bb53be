// Two strands wound as helices about a backbone that is itself bent to a circle: the mean squared curvature that the
// winding adds to one strand.

#include <cmath>
#include <numbers>

#include "host/lab/published/case.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::published {
namespace {

using validate::make;
using validate::Vec;

constexpr double kPi = std::numbers::pi;
constexpr double kLoop = 50.0;  // radius of the loop beside the braid, in radii of the helix
constexpr int kTurns = 8, kNodes = 600;

/// Wave number of the helices, 1 / sqrt(sqrt(12) h R): h = 1 radius of the helix, R radius of the loop.
double wave_number() { return 1.0 / std::sqrt(std::sqrt(12.0) * kLoop); }

/// A point of a strand at s along the backbone; side +1 and -1 are the two strands. bend: the backbone's curvature.
Vec strand(double s, double side, double bend) {
  const double a = wave_number() * s, turned = bend * s;
  const Vec normal = make(std::cos(turned), std::sin(turned), 0);
  const Vec backbone = bend > 0.0 ? (1.0 / bend) * normal : make(0, s, 0);
  return backbone + side * (std::cos(a) * normal + make(0, 0, std::sin(a)));
}

/// Integral of the squared curvature along a strand over the backbone's length, from the bending energy of a rod that
/// is laid along the strand. Lengths are in units of the helix's radius.
double squared_curvature(double side, double bend) {
  const double whole = kTurns * 2.0 * kPi / wave_number();
  auto material = validate::unit_rod();
  validate::Rod measure(material, validate::steps_of(1e-3), validate::kBare, kNodes);
  auto& state = measure.state();
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.x[i] = strand(whole * static_cast<double>(i) / (kNodes - 1), side, bend);
    state.mesh.s[i] = i == 0 ? 0.0 : state.mesh.s[i - 1] + norm(state.x[i] - state.x[i - 1]);
  }
  measure.moved();
  return 2.0 * measure.energy().bend_J / (material.EI_N_m2 * whole);
}

/// What the winding adds, per strand: the two strands' mean less the backbone's own K^2.
double added(double bend) { return 0.5 * (squared_curvature(1.0, bend) + squared_curvature(-1.0, bend)) - bend * bend; }

/// Mean square of the second derivative of the displacement delta between strand and backbone, from differences of
/// points at equal distances along the backbone.
double second_derivative(double bend) {
  const double step = kTurns * 2.0 * kPi / wave_number() / (kNodes - 1);
  const auto delta = [&](int i) { return 0.5 * (strand(i * step, 1.0, bend) - strand(i * step, -1.0, bend)); };
  double sum = 0.0;
  for (int i = 1; i + 1 < kNodes; ++i) {
    const Vec second = (1.0 / (step * step)) * (delta(i + 1) - 2.0 * delta(i) + delta(i - 1));
    sum += dot(second, second);
  }
  return sum / (kNodes - 2);
}

}  // namespace

Result helices(const Subject&) {
  Result result;
  const double straight = added(0.0), straight_second = second_derivative(0.0), k = wave_number();
  constexpr double kTable[][2] = {{200, 1.013}, {100, 1.052}, {70, 1.107}, {50, 1.210},
                                  {35, 1.434},  {30, 1.596},  {20, 2.393}, {15, 3.606}};
  for (const auto& [radius, published] : kTable) {
    const double q = 1.0 / (radius * k), energy = added(1.0 / radius) / straight;
    const double second = second_derivative(1.0 / radius) / straight_second;
    const double expansion = 1.0 - 2.0 * q * q + 0.5 * q * q * q * q;
    const std::string at = "backbone radius " + std::to_string(static_cast<int>(radius)) + ": ";
    result.findings.push_back(validate::relative(at + "squared curvature of the rod", published, energy, 0.05));
    result.findings.push_back(reported(at + "second differences of the nodes", second, ""));
    if (radius >= 50)  // to fourth order in h k and h K; the next order is not small for sharper bends
      result.findings.push_back(
          validate::relative(at + "curvature against 1 - 2 q^2 + q^4/2", expansion, energy, 0.05));
    result.points.push_back({"published table; energy of the rod", q, published, energy});
    result.points.push_back({"1 - 2 q^2 + q^4/2; energy of the rod", q, expansion, energy});
    result.points.push_back({"published table; second differences", q, published, second});
  }
  return result;
}

}  // namespace ligature::published
