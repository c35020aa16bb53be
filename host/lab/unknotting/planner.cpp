#include "host/lab/unknotting/planner.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::lab {
namespace {

using physics::Vec3;

/// Candidate pulls, most promising first.
std::vector<Pull> ranked(std::span<const Vec3> shape_W) {
  const int n = static_cast<int>(shape_W.size());
  const auto core = core_of(shape_W);
  if (core.first > core.last) return {};  // no knot
  const auto at = [&](int k) { return shape_W[static_cast<std::size_t>(std::clamp(k, 0, n - 1))]; };
  const Vec3 along_tail = (at(core.last + 3) - at(core.last - 1)).normalized();
  struct Scored {
    Pull pull;
    double cost;
  };
  std::vector<Scored> all;
  for (int node = core.first; node <= std::min(core.last + 1, n - 2); ++node) {
    for (const auto& d : six_directions()) {
      // 0: three nodes inside the core's end, where the hand holds the last loop
      const double inside = std::abs(node - (core.last - 3));
      const double against = 1.0 + d.dot(along_tail);  // 0: exactly against the tail's direction
      all.push_back({{node, d}, inside + 2.0 * against});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Scored& a, const Scored& b) { return a.cost < b.cost; });
  std::vector<Pull> pulls;
  pulls.reserve(all.size());
  for (const auto& s : all) pulls.push_back(s.pull);
  return pulls;
}

}  // namespace

std::optional<Plan> plan_pull(std::span<const Vec3> shape_W, const scene::Scene& scene) {
  int tried = 0;
  for (const auto& pull : ranked(shape_W)) {
    ++tried;
    const auto result = try_pull(shape_W, scene, pull);
    if (result.finite && result.knot.type == "0_1") return Plan{pull, tried};
  }
  return std::nullopt;
}

}  // namespace ligature::lab
