// Ideal trefoil: a closed trefoil is shrunk without friction until it is tight; the result is length / diameter.

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "firmware/physics/closest.hpp"
#include "host/knot/recognise.hpp"
#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::validate {
namespace {

constexpr double kRadius = 1.5e-4;
// tension at which the knot counts as tight: ten times the drag force while the thread shrinks
constexpr double kTension_N = 0.005;

struct Tight {
  double length_over_diameter = std::numeric_limits<double>::quiet_NaN();
  std::string knot;
};

/// Length of the closed polygon; its last edge is the straight bridge between the clamps.
double contour(const std::vector<Vec>& x) {
  double length = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) length += norm(x[(j + 1) % x.size()] - x[j]);
  return length;
}

/// Smallest distance between strands that are at least pi radii apart along the thread.
double nearest_strands(const std::vector<Vec>& x, double length) {
  const std::size_t edges = x.size();
  std::vector<double> s{0.0};  // arc length at the start of each edge
  for (std::size_t j = 0; j < edges; ++j) s.push_back(s.back() + norm(x[(j + 1) % edges] - x[j]));
  const double skip = 0.5 * std::numbers::pi * 2.0 * kRadius;
  double least = 1e9;
  for (std::size_t a = 0; a < edges; ++a) {
    for (std::size_t b = a + 1; b < edges; ++b) {
      if (s[b] - s[a + 1] < skip || length - s[b + 1] + s[a] < skip) continue;
      least = std::min(least, std::sqrt(physics::closest(x[a], x[a + 1], x[b], x[(b + 1) % edges]).distance2));
    }
  }
  return least;
}

/// The rod cannot be closed. Therefore its ends are clamped in line with each other, and the straight bridge between
/// them counts as part of the knot. The gap is too small for a strand to fit in, and large enough that only the clamped
/// nodes touch each other. The thread's length is reduced until it is taut. With 50 nodes a segment of the tight knot
/// is 0.34 diameters long; contacts between segments less than 0.6 diameters apart along the thread are ignored, so
/// more nodes would only add contacts.
Tight tighten(int n) {
  Material m;
  const double bridge = 0.7 * 2.0 * kRadius, whole = 40.0 * 2.0 * kRadius;
  m.length_m = whole - bridge;
  m.EA_N = 12.0;
  m.EI_N_m2 = 1e-11;
  m.drag_per_s = 50.0;
  m.friction = 0.0;
  Rod rod(m, Numerics{}, Parts{false, true, false, false, false}, n);
  auto& state = rod.state();
  const auto curve = [](double t) {
    return make(std::sin(t) + 2.0 * std::sin(2.0 * t), std::cos(t) - 2.0 * std::cos(2.0 * t), -std::sin(3.0 * t));
  };
  constexpr int kFine = 4000;
  std::vector<double> along(kFine + 1, 0.0);
  const auto place = [&](int k) { return curve(2.0 * std::numbers::pi * k / kFine); };
  for (int k = 1; k <= kFine; ++k)
    along[static_cast<std::size_t>(k)] = along[static_cast<std::size_t>(k - 1)] + norm(place(k) - place(k - 1));
  const double scale = whole / along.back();
  for (int i = 0, k = 0; i < n; ++i) {
    const double wanted = (along.back() - bridge / scale) * i / (n - 1);
    while (k < kFine && along[static_cast<std::size_t>(k) + 1] <= wanted) ++k;
    state.x[static_cast<std::size_t>(i)] = scale * place(std::min(k, kFine));
  }
  const Vec tangent = place(1) - place(0);
  rod.clamp(0, state.x.front(), tangent);
  state.x.back() = state.x.front() - (bridge / norm(tangent)) * tangent;
  rod.clamp(n - 1, state.x.back(), tangent);
  double tension = 0.0, natural = m.length_m;
  for (int k = 0; k < 20000 && tension < kTension_N; ++k) {
    const double shrink = tension < 0.1 * kTension_N ? 2e-4 : 2e-5;  // fraction of the length removed per tick
    natural *= 1.0 - shrink;
    for (auto& at : state.mesh.s) at *= 1.0 - shrink;
    rod.moved();
    proceed(rod);
    if (k % 10 == 0) tension = m.EA_N * ((contour(state.x) - bridge) / natural - 1.0);
  }
  for (int k = 0; k < 500; ++k) proceed(rod);
  std::vector<std::array<double, 3>> points;
  points.reserve(state.x.size());
  for (const auto& x : state.x) points.push_back({x[0], x[1], x[2]});
  const double length = contour(state.x);
  return {length / nearest_strands(state.x, length), knot::recognise(points, true).type};
}

}  // namespace

Findings tight_trefoil(const Subject&) {  // the ideal value is 16.37; a simulated knot must be above it
  const Tight t = tighten(50);
  return {within("length / diameter (smallest strand distance), knot " + t.knot, 16.4, 18.0,
                 t.knot == "3_1" ? t.length_over_diameter : std::numeric_limits<double>::quiet_NaN())};
}

}  // namespace ligature::validate
