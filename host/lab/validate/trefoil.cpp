// A closed trefoil, shrunk without friction until it is tight: length over diameter.

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "firmware/physics/rod/closest.hpp"
#include "host/knot/recognise.hpp"
#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::validate {
namespace {

constexpr double kRadius = 1.5e-4;
constexpr double kTension_N = 0.05;  // that counts as tight: 0.4 % strain of a soft thread

struct Tight {
  double length_over_diameter = std::numeric_limits<double>::quiet_NaN();
  std::string knot;
};

double contour(const Rod& rod) {
  double length = 0.0;
  const auto& x = rod.state().x;
  for (std::size_t j = 0; j + 1 < x.size(); ++j) length += norm(x[j + 1] - x[j]);
  return length;
}

/// Smallest distance of strands at least a quarter turn of the thread's own radius apart along it, around the closure too.
double nearest_strands(const Rod& rod, double length) {
  const auto& x = rod.state().x;
  const int edges = static_cast<int>(x.size()) - 1;
  const double skip = 0.5 * std::numbers::pi * 2.0 * kRadius;
  double least = 1e9;
  for (int a = 0; a < edges; ++a) {
    for (int b = a + 1; b < edges; ++b) {
      const double apart = (b - a - 1) * length / edges, round = (edges - (b - a) - 1) * length / edges;
      if (apart < skip || round < skip) continue;
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      least = std::min(least, std::sqrt(physics::rod::closest(x[i], x[i + 1], x[j], x[j + 1]).distance2));
    }
  }
  return least;
}

/// The thread's ends are clamped to each other; its stress-free length shrinks until it is taut.
Tight tighten(int n) {
  Material m;
  m.length_m = 40.0 * 2.0 * kRadius;
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
  for (int k = 1; k <= kFine; ++k) along[static_cast<std::size_t>(k)] = along[static_cast<std::size_t>(k - 1)] + norm(place(k) - place(k - 1));
  const double scale = m.length_m / along.back();
  for (int i = 0, k = 0; i < n; ++i) {
    const double wanted = along.back() * i / (n - 1);
    while (k < kFine && along[static_cast<std::size_t>(k + 1)] <= wanted) ++k;
    state.x[static_cast<std::size_t>(i)] = scale * place(std::min(k, kFine));
  }
  const Vec tangent = place(1) - place(0);
  rod.clamp(0, state.x.front(), tangent);
  rod.clamp(n - 1, state.x.front(), tangent);
  double tension = 0.0, shrunk = 0.0;
  for (int k = 0; k < 8000 && tension < kTension_N; ++k) {
    const double speed = tension < 0.1 * kTension_N ? 2e-4 : 2e-5;  // of its length a tick
    shrunk = std::min(0.9, shrunk + speed);
    for (auto& strain : state.rest_strain) strain = -shrunk;
    rod.tick();
    if (k % 10 == 0) tension = m.EA_N * (contour(rod) / m.length_m - 1.0 + shrunk);
  }
  for (int k = 0; k < 500; ++k) rod.tick();
  std::vector<std::array<double, 3>> points;
  for (const auto& x : state.x) points.push_back({x[0], x[1], x[2]});
  points.pop_back();
  const double length = contour(rod);
  return {length / nearest_strands(rod, length), knot::recognise(points, true).type};
}

}  // namespace

Findings tight_trefoil(const Subject& subject) {  // ideal: 16.37; a simulated one must lie above
  const Tight t = tighten(subject.nodes);
  return {within("length / diameter (smallest strand distance), knot " + t.knot, 16.4, 18.0,
                 t.knot == "3_1" ? t.length_over_diameter : std::numeric_limits<double>::quiet_NaN())};
}

}  // namespace ligature::validate
