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

/// Integral of ds (L - s)^power / EI(s) over the thread, of length L.
double over_stiffness(double length_m, double EI_N_m2, const std::vector<scene::StiffRegion>& regions, int power) {
  const auto integral = [&](double from_m, double to_m) {
    return (std::pow(length_m - from_m, power + 1) - std::pow(length_m - to_m, power + 1)) / (power + 1);
  };
  double sum = integral(0.0, length_m) / EI_N_m2;
  for (const auto& r : regions) sum += integral(r.from_m, r.to_m) * (1.0 / r.EI_N_m2 - 1.0 / EI_N_m2);
  return sum;
}

// A moment M that is constant along the thread bends it by M times the integral of ds / EI, wherever the nodes are:
// the vertices are springs in series, of stiffness w_i, and 2 EI / l at the clamped ends.
TEST(StiffnessProfile, TheAngleUnderAConstantMomentIsExactForEveryMesh) {
  test::Random random(101);
  for (int k = 0; k < 100; ++k) {
    Material m;
    const double first_m = random.in(0.0, 0.1), second_m = random.in(0.1, 0.2);
    const double stiff = m.EI_N_m2 * random.in(2.0, 50.0), soft = m.EI_N_m2 * random.in(0.1, 0.9);
    const std::vector<scene::StiffRegion> regions{{first_m, second_m, stiff}, {second_m, 0.25, soft}};
    for (const auto& r : regions) m.regions.push_back({r.from_m, r.to_m, r.EI_N_m2});
    Mesh mesh;
    mesh.resize(30);
    for (std::size_t i = 1; i < 30; ++i) mesh.s[i] = mesh.s[i - 1] + random.in(0.1, 1.0);
    for (auto& s : mesh.s) s *= m.length_m / mesh.s.back();
    mesh.clamp.front() = mesh.clamp.back() = Clamp::kClamped;
    mesh.rebuild(m);
    const double l_first = mesh.rest[0], l_last = mesh.rest[28];
    double angle = l_first / (2.0 * mesh.EI_after[0]) + l_last / (2.0 * mesh.EI_before[29]);
    for (std::size_t i = 1; i < 29; ++i) angle += 1.0 / mesh.weight[i];
    const double wanted = over_stiffness(m.length_m, m.EI_N_m2, regions, 0);
    EXPECT_NEAR(angle, wanted, 1e-12 * wanted) << k;
  }
}

constexpr double kLength_m = 0.03, kEI_N_m2 = 1e-6;

/// How far the end of a horizontal thread sags under its weight, if node 0 is clamped.
double sag_m(scene::Spacing spacing, const std::vector<scene::StiffRegion>& regions) {
  scene::Scene s;
  s.suture.model = scene::Model::kRod;
  s.suture.nodes = 61;
  s.suture.length_m = kLength_m;
  s.suture.radius_m = 1.5e-4;
  s.suture.rod.spacing = spacing;
  s.suture.rod.EI_N_m2 = kEI_N_m2;
  s.suture.rod.air_drag_per_s = 30.0;
  s.suture.rod.stiffness_profile = regions;
  s.suture.initial = "laid";
  s.suture.initial_polyline_m = {{0, 0, 0}, {kLength_m, 0, 0}};
  s.contact.solver = scene::ContactSolver::kNone;
  s.world.grippers_collide = s.world.frame_collides = false;
  s.world.fixed.push_back({0, {0, 0, 0}, scene::Vec{1, 0, 0}});
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
      const double wanted = 0.5 * weight_N_per_m * over_stiffness(kLength_m, kEI_N_m2, regions, 3);
      EXPECT_NEAR(sag_m(spacing, regions), wanted, 0.01 * wanted) << regions.size();
      EXPECT_LT(wanted, 1e-4) << "so that the beam equation holds";
    }
  }
}

}  // namespace
}  // namespace ligature::test
