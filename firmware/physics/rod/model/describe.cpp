#include "firmware/physics/rod/model/describe.hpp"

#include <algorithm>

namespace ligature::physics::rod {

void describe(const Rod& rod, std::span<float> tension_N, std::span<float> turn_rad) noexcept {
  const auto& s = rod.state().mesh.s;
  const Forces& forces = rod.forces();
  const std::size_t edges = s.size() - 1;
  for (std::size_t i = 0; i < tension_N.size(); ++i)
    tension_N[i] = static_cast<float>(forces.tension[std::min(i, edges - 1)]);
  double turn = 0.0;
  for (std::size_t i = 0; i < turn_rad.size(); ++i) {
    turn_rad[i] = static_cast<float>(turn);
    // A segment is twisted only if both its ends have a twisting moment: beyond the last hold the thread turns freely
    const bool is_twisted = i < edges && forces.twist_moment[i] != 0.0 && forces.twist_moment[i + 1] != 0.0;
    if (is_twisted && rod.material().GJ_N_m2 > 0.0)
      turn += forces.twist_moment[i] * (s[i + 1] - s[i]) / rod.material().GJ_N_m2;
  }
}

}  // namespace ligature::physics::rod
