// Parts of the thread with a bending stiffness of their own.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "firmware/physics/rod/mesh/mesh.hpp"
#include "firmware/physics/rod/rod_simulation.hpp"
#include "tests/support/random.hpp"

namespace ligature::test {
namespace {

using physics::rod::Clamp;
using physics::rod::Material;
using physics::rod::Mesh;
using physics::rod::RodSimulation;

/// Integral of f(s) / EI(s) from 0 to the thread's end, by the midpoint rule.
template <class F>
double over_stiffness(const Material& m, F f) {
  constexpr int kPieces = 200'000;
  double sum = 0.0;
  for (int k = 0; k < kPieces; ++k) {
    const double s = (k + 0.5) * m.length_m / kPieces;
    double EI_N_m2 = m.EI_N_m2;
    for (const auto& region : m.regions)
      if (s >= region.from_m && s < region.to_m) EI_N_m2 = region.EI_N_m2;
    sum += f(s) / EI_N_m2;
  }
  return sum * m.length_m / kPieces;
}

// A moment M that is constant along the thread bends it by M times the integral of ds / EI, wherever the nodes are:
// the vertices are springs in series, of stiffness w_i, and 2 EI / l at the clamped ends.
TEST(StiffnessProfile, TheAngleUnderAConstantMomentIsExactForEveryMesh) {
  test::Random random(101);
  for (int k = 0; k < 100; ++k) {
    Material m;
    const double first = random.in(0.0, 0.1), second = random.in(0.1, 0.2);
    m.regions = {{first, second, m.EI_N_m2 * random.in(2.0, 50.0)}, {second, 0.25, m.EI_N_m2 * random.in(0.1, 0.9)}};
    Mesh mesh;
    mesh.resize(30);
    for (std::size_t i = 1; i < 30; ++i) mesh.s[i] = mesh.s[i - 1] + random.in(0.1, 1.0);
    for (auto& s : mesh.s) s *= m.length_m / mesh.s.back();
    mesh.clamp.front() = mesh.clamp.back() = Clamp::kClamped;
    mesh.rebuild(m);
    const double l_first = mesh.rest[0], l_last = mesh.rest[28];
    double angle = l_first / (2.0 * mesh.EI_after[0]) + l_last / (2.0 * mesh.EI_before[29]);
    for (std::size_t i = 1; i < 29; ++i) angle += 1.0 / mesh.weight[i];
    const double wanted = over_stiffness(m, [](double) { return 1.0; });
    EXPECT_NEAR(angle, wanted, 1e-4 * wanted) << k;
  }
}

/// How far the end of a clamped horizontal thread of 30 mm sags under its weight.
double sag_m(scene::Spacing spacing, const std::vector<scene::StiffRegion>& regions, const scene::Vec& direction) {
  scene::Scene s;
  s.suture.model = scene::Model::kRod;
  s.suture.nodes = 61;
  s.suture.length_m = 0.03;
  s.suture.radius_m = 1.5e-4;
  s.suture.rod.spacing = spacing;
  s.suture.rod.EI_N_m2 = 1e-6;
  s.suture.rod.air_drag_per_s = 30.0;
  s.suture.rod.stiffness_profile = regions;
  s.suture.initial = "laid";
  s.suture.initial_polyline_m = {{0, 0, 0}, {0.03 * direction[0], 0, 0}};
  s.contact.solver = scene::ContactSolver::kNone;
  s.world.grippers_collide = s.world.frame_collides = false;
  s.world.fixed.push_back({0, {0, 0, 0}, direction});
  auto made = RodSimulation::make(s);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  auto sim = std::get<RodSimulation>(std::move(made));
  for (int k = 0; k < 1000; ++k) sim.tick({});
  return -sim.nodes_W().back().z();
}

// A cantilever under its weight q sags by q/2 times the integral of (L - s)^3 / EI, if it sags little.
TEST(StiffnessProfile, AThreadWithAStiffRootSagsAsTheBeamEquationSays) {
  const double weight_N_per_m = scene::Scene{}.suture.rod.density_kg_per_m * 9.81;
  for (const auto spacing : {scene::Spacing::kUniform, scene::Spacing::kAdaptive}) {
    for (const std::vector<scene::StiffRegion>& regions :
         {std::vector<scene::StiffRegion>{}, {{0.0, 0.008, 5e-6}}, {{0.01, 0.02, 3e-6}, {0.02, 0.03, 5e-7}}}) {
      Material m;
      m.length_m = 0.03, m.EI_N_m2 = 1e-6;
      for (const auto& r : regions) m.regions.push_back({r.from_m, r.to_m, r.EI_N_m2});
      const double wanted = 0.5 * weight_N_per_m * over_stiffness(m, [](double s) { return std::pow(0.03 - s, 3); });
      EXPECT_NEAR(sag_m(spacing, regions, {1, 0, 0}), wanted, 0.01 * wanted) << regions.size();
      EXPECT_LT(wanted, 1e-4) << "so that the beam equation holds";
    }
  }
}

}  // namespace
}  // namespace ligature::test
