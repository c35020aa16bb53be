// Safety test for merging two segments: while they move to their common chord, they must not cross anything.

#include <cmath>
#include <numbers>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/mesh/refine.hpp"

namespace ligature::physics::rod {

bool merge_is_clear(const Material& material, const State& state, const std::vector<Body>& bodies,
                    std::size_t node) noexcept {
  const auto& x = state.x;
  const auto& s = state.mesh.s;
  const Vec before = x[node - 1], here = x[node], after = x[node + 1];
  const double share = (s[node] - s[node - 1]) / (s[node + 1] - s[node - 1]);
  const double h = norm(here - ((1.0 - share) * before + share * after));
  const double diameter = 2.0 * material.radius_m, bent_arc = 0.5 * std::numbers::pi * diameter;
  const double size = std::sqrt(std::max(dot(before - here, before - here), dot(after - here, after - here)));
  const auto clear = [&](Vec p, Vec q, double distance) {
    const Vec off = 0.5 * (p + q) - here;
    const double far = size + 0.5 * norm(q - p) + distance;
    if (dot(off, off) > far * far) return true;
    const double least2 = distance * distance;
    return closest(before, here, p, q).distance2 > least2 && closest(here, after, p, q).distance2 > least2;
  };
  for (std::size_t j = 0; j + 1 < x.size(); ++j) {
    if (j + 2 >= node && j <= node + 1) continue;  // the two segments themselves, and those adjacent to the chord
    const double arc = j > node ? s[j] - s[node + 1] : s[node - 1] - s[j + 1];
    if (!clear(x[j], x[j + 1], arc < bent_arc ? 1.001 * h : h + diameter)) return false;
  }
  for (const auto& body : bodies) {
    if (!clear(body.p0, body.p1, h + material.radius_m + body.radius_m)) return false;
  }
  return true;
}

}  // namespace ligature::physics::rod
