#include "firmware/physics/rod/mesh/mesh.hpp"

#include <algorithm>
#include <array>

namespace ligature::physics::rod {

void Mesh::resize(int n) {
  const auto size = static_cast<std::size_t>(n);
  for (auto* array : {&s, &rest, &inv_rest, &mass, &weight, &kd, &ke, &kb}) array->resize(size);
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
    weight[i] = 0.0;
    if (clamp[i] == Clamp::kClamped) {
      if (before > 0.0) add(i, 2.0 * material.EI_N_m2 / before, 1.0 / before, 0.0);
      if (after > 0.0) add(i, 2.0 * material.EI_N_m2 / after, 0.0, 1.0 / after);
    } else if (before > 0.0 && after > 0.0) {
      weight[i] = 2.0 * material.EI_N_m2 / (before + after);
      add(i, weight[i], 1.0 / before, 1.0 / after);
    }
  }
}

}  // namespace ligature::physics::rod
