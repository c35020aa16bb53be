#include "host/lab/script_moves.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::lab {
namespace {

template <class F>
scene::GripperScript changed(scene::GripperScript script, F change) {
  for (auto& keys : script.keys) {
    for (auto& key : keys) change(key);
  }
  return script;
}

}  // namespace

scene::GripperScript mirrored(scene::GripperScript script) {
  return changed(std::move(script), [](scene::GripKey& k) {
    for (auto* along : {&k.p_W_m, &k.v_W_m_per_s}) (*along)[0] = -(*along)[0];
  });
}

scene::GripperScript turned(scene::GripperScript script, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return changed(std::move(script), [c, s](scene::GripKey& k) {
    for (auto* v : {&k.p_W_m, &k.v_W_m_per_s}) *v = {c * (*v)[0] - s * (*v)[1], s * (*v)[0] + c * (*v)[1], (*v)[2]};
  });
}

scene::GripperScript paced(scene::GripperScript script, double factor) {
  return changed(std::move(script), [factor](scene::GripKey& k) {
    k.time_s /= factor;
    for (auto* rate : {&k.v_W_m_per_s, &k.turn_deg_per_s})
      for (double& r : *rate) r *= factor;
  });
}

double release_time_s(const scene::GripperScript& script) {
  double last_s = 0.0;
  for (const auto& keys : script.keys) {
    for (std::size_t k = 1; k < keys.size(); ++k) {
      if (keys[k - 1].grip && !keys[k].grip) last_s = std::max(last_s, keys[k].time_s);
    }
  }
  return last_s > 0.0 ? last_s : scene::end_time_s(script);
}

}  // namespace ligature::lab
