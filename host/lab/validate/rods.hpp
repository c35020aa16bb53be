#pragma once
// Rods used without physics::Simulation, for features that it does not offer: rolling clamps, closed loops, given
// masses.

#include <algorithm>
#include <array>

#include "firmware/physics/rod/rod.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::validate {

using physics::rod::make;
using physics::rod::Material;
using physics::rod::Numerics;
using physics::rod::Parts;
using physics::rod::Rod;
using physics::rod::Twist;
using physics::rod::Vec;

inline constexpr Parts kBare{false, false, false, false, false};
inline constexpr Parts kTwisting{true, false, false, false, false};

/// A rod with length, density and bending stiffness 1. Its stretch stiffness is 1e6 EI / L^2, so high that stretch
/// changes results by 1e-6 only.
[[nodiscard]] inline Material unit_rod() {
  Material m;
  m.length_m = 1.0;
  m.radius_m = 1e-3;
  m.density_kg_per_m = 1.0;
  m.EA_N = 1e6;
  m.EI_N_m2 = 1.0;
  m.GJ_N_m2 = 1.0;
  m.stretch_tau_s = 0.0;
  m.bend_tau_s = 0.0;
  m.drag_per_s = 0.0;
  return m;
}

/// One implicit Euler step per tick, whose numerical damping is proportional to the tick's length.
[[nodiscard]] inline Numerics steps_of(double tick_s) {
  Numerics n;
  n.tick_s = tick_s;
  n.substeps = n.max_substeps = 1;
  return n;
}

/// Runs until no node is faster than still_m_per_s. @return false when that takes more than `most` ticks.
inline bool settle(Rod& rod, double still_m_per_s, int most) {
  for (int k = 0; k < most; ++k) {
    proceed(rod);
    double fastest = 0.0;
    for (const auto& v : rod.state().v) fastest = std::max(fastest, norm(v));
    if (k > 10 && fastest < still_m_per_s) return true;
  }
  return false;
}

/// Rotates a hold's end by `angle_rad`, in steps small enough for the turn counter.
void wind(Rod& rod, int hold, double angle_rad);

}  // namespace ligature::validate
