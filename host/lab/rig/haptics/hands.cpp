#include "host/lab/rig/haptics/hands.hpp"

namespace ligature::lab {
namespace {

constexpr double kHold_m = 0.095, kY_m = -0.0099, kZ_m = 0.050;

scene::GripKey key(double t, std::size_t hand, double x, bool grip) {
  return {t, {hand == 0 ? -x : x, kY_m, kZ_m}, grip};
}

}  // namespace

scene::GripperScript pull_and_release(double apart_m, double draw_s, double rest_s) {
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) {
    double t = 1.2;  // the rig engages first
    script.keys[h] = {key(0.5, h, kHold_m, false), key(t, h, kHold_m, true)};
    script.keys[h].push_back(key(t += draw_s, h, apart_m, true));
    script.keys[h].push_back(key(t += rest_s, h, apart_m, false));  // lets go under tension
    script.keys[h].push_back(key(t += 0.5, h, apart_m, false));
  }
  return script;
}

scene::GripperScript jam(double apart_m, double beat_s, int times) {
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) {
    double t = 1.2;
    script.keys[h] = {key(0.5, h, kHold_m, false), key(t, h, kHold_m, true)};
    script.keys[h].push_back(key(t += 1.5, h, apart_m, true));
    for (int i = 0; i < times; ++i) {
      script.keys[h].push_back(key(t += beat_s, h, apart_m - 0.012, true));
      script.keys[h].push_back(key(t += beat_s, h, apart_m, true));
    }
    script.keys[h].push_back(key(t + 0.3, h, apart_m, false));
  }
  return script;
}

scene::GripperScript slip(double apart_m) {
  scene::GripperScript script = pull_and_release(apart_m, 1.5, 2.2);
  auto& right = script.keys[1];
  const scene::GripKey last = right.back();
  right.resize(3);
  for (double t = 3.0; t < 4.8; t += 0.3) {
    right.push_back(key(t, 1, apart_m, false));
    right.push_back(key(t + 0.1, 1, apart_m, true));
  }
  right.push_back(key(4.9, 1, apart_m, false));
  if (last.time_s > 4.9) right.push_back(last);
  return script;
}

}  // namespace ligature::lab
