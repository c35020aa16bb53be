#include "protocol/scene/rod_keys.hpp"

#include <cmath>
#include <numbers>

namespace ligature::scene {
namespace {

constexpr double kPoisson = 0.4;

constexpr std::pair<const char*, Spacing> kSpacings[] = {{"uniform", Spacing::kUniform},
                                                         {"adaptive", Spacing::kAdaptive}};
constexpr std::pair<const char*, Accuracy> kAccuracies[] = {
    {"fast", Accuracy::kFast}, {"balanced", Accuracy::kBalanced}, {"fine", Accuracy::kFine}};

// Solid round section: A = pi d^2 / 4, I = pi d^4 / 64, J = 2 I, G = E / 2 (1 + nu).
void apply(const RodPreset& p, RodParameters& rod, double& radius_m) {
  const double d2 = p.diameter_m * p.diameter_m, area_m2 = std::numbers::pi * d2 / 4.0;
  radius_m = 0.5 * p.diameter_m;
  rod.density_kg_per_m = p.density_kg_per_m3 * area_m2;
  rod.EA_N = p.modulus_Pa * area_m2;
  rod.EI_N_m2 = p.bend_share * p.modulus_Pa * area_m2 * d2 / 16.0;
  rod.GJ_N_m2 = rod.EI_N_m2 / (1.0 + kPoisson);
}

void read_regions(StrictTable& t, double length_m, std::vector<StiffRegion>& regions) {
  t.tables("stiffness_profile", [&](StrictTable& one) {
    StiffRegion region;
    for (const char* key : {"from_m", "to_m", "EI_N_m2"}) one.require(key);
    const double start_m = regions.empty() ? 0.0 : regions.back().to_m;
    one.number("from_m", region.from_m, {0.0, 1e3});
    one.number("to_m", region.to_m, {0.0, 1e3});
    one.number("EI_N_m2", region.EI_N_m2, {1e-12, 1e6});
    if (region.from_m < start_m) one.refuse("from_m", "the end of the region before it, or more");
    if (!(region.to_m > region.from_m)) one.refuse("to_m", "more than from_m");
    if (region.to_m > length_m) one.refuse("to_m", "suture.length_m or less");
    regions.push_back(region);
  });
  constexpr std::size_t kMostRegions = 8;
  if (regions.size() > kMostRegions) t.refuse("stiffness_profile", std::to_string(kMostRegions) + " regions at most");
}

}  // namespace

void read_rod(StrictTable& t, double length_m, RodParameters& rod, double& radius_m) {
  std::string preset;
  t.text("preset", preset);
  if (!preset.empty()) {
    std::string names;
    bool found = false;
    for (const auto& p : kRodPresets) {
      names += std::string(names.empty() ? "" : ", ") + p.name;
      if (preset != p.name) continue;
      apply(p, rod, radius_m);
      found = true;
    }
    if (!found) return t.refuse("preset", "one of " + names);
  }
  t.number("density_kg_per_m", rod.density_kg_per_m, {1e-9, 1e4});
  t.number("EA_N", rod.EA_N, {1e-6, 1e9});
  t.number("EI_N_m2", rod.EI_N_m2, {0.0, 1e6});
  t.number("GJ_N_m2", rod.GJ_N_m2, {0.0, 1e6});
  t.number("rest_curvature_per_m", rod.rest_curvature_per_m, {0.0, 1e5});
  t.number("rest_twist_per_m", rod.rest_twist_per_m, {-1e5, 1e5});
  t.number("yield_strain", rod.yield_strain, {1e-6, 1.0});
  t.number("set_fraction", rod.set_fraction, {0.0, 1.0});
  read_regions(t, length_m, rod.stiffness_profile);
  t.number("damping_s", rod.damping_s, {0.0, 1e3});
  t.number("stretch_damping_s", rod.stretch_damping_s, {0.0, 1e3});
  t.choice("spacing", rod.spacing, kSpacings);
  t.choice("accuracy", rod.accuracy, kAccuracies);
  t.integer("work_instructions", rod.work_instructions, 100'000, 1'000'000'000);
}

void read_pegs(StrictTable& t, World& world) {
  t.tables("pegs", [&](StrictTable& p) {
    Peg peg;
    p.require("from_m");
    p.require("to_m");
    p.require("radius_m");
    p.vector("from_m", peg.from_m, 1e4);
    p.vector("to_m", peg.to_m, 1e4);
    p.number("radius_m", peg.radius_m, {1e-6, 100.0});
    p.number("surface_m_per_s", peg.surface_m_per_s, {-1e3, 1e3});
    const auto &a = peg.from_m, &b = peg.to_m;
    if (peg.surface_m_per_s != 0.0 && !(std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) >= 1e-6))
      p.refuse("surface_m_per_s", "0 for a bar shorter than 1e-6 m");
    world.pegs.push_back(peg);
  });
  constexpr std::size_t kMostPegs = 100;
  if (world.pegs.size() > kMostPegs) t.refuse("pegs", std::to_string(kMostPegs) + " at most");
}

}  // namespace ligature::scene
