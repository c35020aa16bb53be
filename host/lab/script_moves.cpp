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
  return changed(std::move(script), [](scene::GripKey& k) { k.p_W_m[0] = -k.p_W_m[0]; });
}

scene::GripperScript turned(scene::GripperScript script, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return changed(std::move(script), [c, s](scene::GripKey& k) {
    k.p_W_m = {c * k.p_W_m[0] - s * k.p_W_m[1], s * k.p_W_m[0] + c * k.p_W_m[1], k.p_W_m[2]};
  });
}

scene::GripperScript paced(scene::GripperScript script, double factor) {
  return changed(std::move(script), [factor](scene::GripKey& k) { k.time_s /= factor; });
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
