// Localised buckling: a long rod, twisted by 27 turns and shortened by 3 %, forms one helical bulge.

#include "host/lab/validate/helix.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/rods.hpp"

namespace ligature::validate {
namespace {

struct Profile {
  // per segment: material coordinate, and cosine of the angle between tangent and axis
  std::vector<double> place, cosine;
  double centre = 0.0, least = 1.0;
};

Profile profile_of(const Rod& rod) {
  Profile p;
  const auto& x = rod.state().x;
  double mass = 0.0;
  std::size_t lowest = 0;
  for (std::size_t j = 0; j + 1 < x.size(); ++j) {
    const Vec e = x[j + 1] - x[j];
    p.cosine.push_back(e[0] / norm(e));
    p.place.push_back(0.5 * (rod.state().mesh.s[j] + rod.state().mesh.s[j + 1]));
    mass += 1.0 - p.cosine[j];
    p.centre += p.place[j] * (1.0 - p.cosine[j]);
    if (p.cosine[j] < p.cosine[lowest]) lowest = j;
  }
  p.centre /= mass;
  p.least = p.cosine[lowest];
  if (lowest > 0 && lowest + 1 < p.cosine.size()) {  // the minimum lies between segments: parabola through three values
    const double a = p.cosine[lowest - 1], b = p.least, c = p.cosine[lowest + 1];
    p.least = b - (c - a) * (c - a) / (8.0 * std::max(a + c - 2.0 * b, 1e-12));
  }
  return p;
}

}  // namespace

HelixTruth helix_truth() {  // of the table's two solutions the one with the larger moment m: a smooth bulge
  const auto json = nlohmann::json::parse(reference_text("04_localised_helical_buckling.json"));
  HelixTruth truth{};
  double largest = 0.0;
  for (const auto& branch : json.at("branches")) {
    const double m = branch.at("m");
    if (m < largest) continue;
    largest = m;
    truth = {branch.at("phi0_rad"), branch.at("M"), branch.at("decay_rate_sigma")};
  }
  return truth;
}

Helix localised_helix_of(int n, int substeps, bool adaptive) {
  Material m;
  m.length_m = 100.0;
  m.density_kg_per_m = 1.0;
  m.EA_N = 1e5;
  m.EI_N_m2 = 1.345;
  m.GJ_N_m2 = 0.789;
  m.drag_per_s = 0.5;
  m.stretch_tau_s = m.bend_tau_s = 0.0;
  Numerics numerics = steps_of(0.1);
  numerics.substeps = numerics.max_substeps = substeps;
  m.radius_m = 0.5;  // limits the finest segment to one unit; the decay length is 4.6
  Rod rod(m, numerics, Parts{true, false, false, false, adaptive}, n);
  rod.clamp(0, make(0, 0, 0), make(1, 0, 0));
  const int end = rod.clamp(n - 1, make(100, 0, 0), make(1, 0, 0));
  for (std::size_t i = 1; i + 1 < rod.state().x.size(); ++i) {
    const double s = rod.state().mesh.s[i] - 50.0;
    rod.state().x[i] += make(0, 1e-3 * std::exp(-s * s / 50.0), 0);
  }
  std::array<Vec, physics::rod::kMaxHolds> goals{};
  for (std::size_t h = 0; h < goals.size(); ++h) goals[h] = rod.state().holds[h].target;
  const int steps = 8000;
  for (int k = 0; k < steps; ++k) {
    Twist::roll(rod.state().holds[static_cast<std::size_t>(end)], 27.0 * 2.0 * std::numbers::pi / steps);
    goals[static_cast<std::size_t>(end)] = make(100.0 - 3.0 * (k + 1) / steps, 0, 0);
    proceed(rod, goals);
  }
  settle(rod, 1e-7, 20000);
  const auto truth = helix_truth();
  const Profile p = profile_of(rod);
  Helix helix;
  helix.angle_rad = std::acos(p.least);
  helix.moment_Nm = rod.twist().moment_Nm(0);
  for (std::size_t j = 0; j < p.cosine.size(); ++j) {
    const double f = (p.cosine[j] - p.least) / (1.0 - p.least), t = std::tanh(truth.sigma * (p.place[j] - p.centre));
    helix.envelope_error = std::max(helix.envelope_error, std::abs(f - t * t));
  }
  return helix;
}

// reference: solution for an infinite rod; the finite length changes it by exp(-21)
Findings localised_helix(const Subject& subject) {
  const auto truth = helix_truth();
  const Helix found = localised_helix_of(subject.nodes, 1, true);
  return {absolute("envelope: largest |f - tanh^2(sigma s)|", 0.0, found.envelope_error, 0.03, "of 1"),
          relative("largest angle to the axis, rad", truth.phi0_rad, found.angle_rad, 0.02),
          relative("twisting moment, N m", truth.M, found.moment_Nm, 0.02)};
}

}  // namespace ligature::validate
