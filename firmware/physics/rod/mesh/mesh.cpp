#include "firmware/physics/rod/mesh/mesh.hpp"

#include <algorithm>
#include <array>

namespace ligature::physics::rod {

namespace {

/// Harmonic mean of the bending stiffness from `from` to `to`, N m^2: with it the angle of a bend under a constant
/// moment is exact wherever the nodes are.
double stiffness(const Material& material, double from, double to) noexcept {
  double compliance = 0.0, elsewhere = to - from;  // integral of ds / EI in the regions; length outside of them
  for (const auto& region : material.regions) {
    const double inside = std::min(to, region.to_m) - std::max(from, region.from_m);
    if (inside <= 0.0) continue;
    compliance += inside / region.EI_N_m2;
    elsewhere -= inside;
  }
  if (compliance == 0.0) return material.EI_N_m2;
  if (elsewhere > 0.0) compliance += elsewhere / material.EI_N_m2;
  return (to - from) / compliance;
}

/// Stiffness of two halves of the lengths a and b in series.
double in_series(double a, double EI_a, double b, double EI_b) noexcept {
  return EI_a == EI_b ? EI_a : (a + b) / (a / EI_a + b / EI_b);
}

}  // namespace

void Mesh::resize(int n) {
  const auto size = static_cast<std::size_t>(n);
  for (auto* array : {&s, &rest, &inv_rest, &mass, &weight, &EI_before, &EI_after, &kd, &ke, &kb}) array->resize(size);
  clamp.resize(size, Clamp::kFree);
}

void Mesh::rebuild(const Material& material) noexcept {
  const std::size_t n = s.size();
  for (std::size_t j = 0; j + 1 < n; ++j) {
    rest[j] = s[j + 1] - s[j];
    inv_rest[j] = 1.0 / rest[j];
  }
  rest[n - 1] = inv_rest[n - 1] = 0.0;
  for (auto* array : {&kd, &ke, &kb}) std::fill(array->begin(), array->end(), 0.0);

  // Adds w g g^T of one vertex on nodes i-1, i, i+1; a missing side has g = 0.
  const auto add = [&](std::size_t i, double w, double g_before, double g_after) {
    const double g_here = -g_before - g_after;
    kd[i] += w * g_here * g_here;
    if (g_before != 0.0) {
      kd[i - 1] += w * g_before * g_before;
      ke[i - 1] += w * g_before * g_here;
    }
    if (g_after != 0.0) {
      kd[i + 1] += w * g_after * g_after;
      ke[i] += w * g_here * g_after;
    }
    if (g_before != 0.0 && g_after != 0.0) kb[i - 1] += w * g_before * g_after;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? rest[i - 1] : 0.0, after = rest[i];
    mass[i] = 0.5 * material.density_kg_per_m * (before + after);
    EI_before[i] = stiffness(material, s[i] - 0.5 * before, s[i]);
    EI_after[i] = stiffness(material, s[i], s[i] + 0.5 * after);
    weight[i] = 0.0;
    if (clamp[i] == Clamp::kClamped) {
      if (before > 0.0) add(i, 2.0 * EI_before[i] / before, 1.0 / before, 0.0);
      if (after > 0.0) add(i, 2.0 * EI_after[i] / after, 0.0, 1.0 / after);
    } else if (before > 0.0 && after > 0.0) {
      weight[i] = 2.0 * in_series(before, EI_before[i], after, EI_after[i]) / (before + after);
      add(i, weight[i], 1.0 / before, 1.0 / after);
    }
  }
}

}  // namespace ligature::physics::rod
