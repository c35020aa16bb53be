#include "host/lab/experiments/experiment.hpp"

namespace ligature::lab {

void lay_level(scene::Scene& s) {
  const auto from = s.world.fixed.empty() ? scene::Vec{0.0, 0.0, 0.0} : s.world.fixed.front().position_m;
  const double rest_m = s.suture.length_m / (s.suture.nodes - 1);
  s.suture.initial = "level";
  s.suture.initial_polyline_m.clear();
  for (int k = 0; k < s.suture.nodes; ++k)
    s.suture.initial_polyline_m.push_back({from[0] + k * rest_m, from[1], from[2]});
}

}  // namespace ligature::lab
