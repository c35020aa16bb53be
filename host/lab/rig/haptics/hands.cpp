#include "host/lab/rig/haptics/hands.hpp"

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

namespace ligature::lab {
namespace {

constexpr double kHold_m = 0.08, kY_m = -0.0099, kZ_m = 0.050;
constexpr double kShort_m = 0.02;
constexpr std::array<double, 3> kPost_m{-0.05, kY_m, kZ_m + kShort_m};

scene::GripKey key(double t, std::size_t hand, double x, bool grip) {
  return {t, {hand == 0 ? -x : x, kY_m, kZ_m}, grip};
}

/// A common displacement of both hands, relative to where they pulled the thread tight.
struct Shift {
  double takes_s, x_m, y_m;
  bool grip = true;
};

scene::GripperScript draw_and_shift(double apart_m, double draw_s, std::initializer_list<Shift> shifts) {
  scene::GripperScript script = pull_and_release(apart_m, draw_s, 0.0);
  for (auto& keys : script.keys) {
    keys.resize(3);
    const scene::GripKey drawn = keys.back();
    for (const Shift& s : shifts) {
      const auto& p = drawn.p_W_m;
      keys.push_back({keys.back().time_s + s.takes_s, {p[0] + s.x_m, p[1] + s.y_m, p[2]}, s.grip});
    }
  }
  return script;
}

}  // namespace

double apart_when_felt_m(const scene::Scene& knotted, double force_N) {
  constexpr double kDraw_s = 3.0, kFar_m = 0.15;
  VirtualRig rig({.scene = knotted}, pull_and_release(kFar_m, kDraw_s, 0.0));
  double apart_m = 0.0;
  rig.each_tick = [&] {
    if (apart_m > 0.0 || rig.controller.hand(0).f_device_N.norm() < force_N) return;
    apart_m = 0.5 * (rig.controller.hand(1).p_WT - rig.controller.hand(0).p_WT).norm();
    rig.cycle.end_after(0);
  };
  if (const auto why = rig.run(5000)) throw std::runtime_error("the rig did not start: " + *why);
  if (apart_m == 0.0) throw std::runtime_error("the knot was never felt");
  return apart_m;
}

scene::GripperScript pull_and_release(double apart_m, double draw_s, double rest_s) {
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) {
    double t = 1.2;  // time of the grasp; the rig needs until then to start up and engage
    script.keys[h] = {key(0.5, h, kHold_m, false), key(t, h, kHold_m, true)};
    script.keys[h].push_back(key(t += draw_s, h, apart_m, true));
    script.keys[h].push_back(key(t += rest_s, h, apart_m, false));  // released under tension
    script.keys[h].push_back(key(t + 0.5, h, apart_m, false));
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
  double t = 3.0;
  for (int k = 0; k < 7; ++k, t += 0.3) {
    right.push_back(key(t, 1, apart_m, false));
    right.push_back(key(t + 0.1, 1, apart_m, true));
  }
  right.push_back(key(4.9, 1, apart_m, false));
  if (last.time_s > 4.9) right.push_back(last);
  return script;
}

scene::GripperScript against_peg(double apart_m, double push_m) {
  const double y = push_m;
  return draw_and_shift(apart_m, 1.2, {{0.6, 0.0, y}, {0.6, 0.0, 0.5 * y}, {0.6, 0.0, y}, {0.4, 0.0, y, false}});
}

// both hands move to the left, so that the left hand drags the right one by the thread
scene::GripperScript give_way(double apart_m, double shift_m) {
  const double x = -shift_m;
  return draw_and_shift(apart_m, 1.5, {{1.0, x, 0.0}, {0.5, x, 0.0}, {0.3, x, 0.0, false}});
}

scene::GripperScript on_a_short_thread(double pull_m) {
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) {
    const double x = h == 0 ? kPost_m[0] : 0.08;
    const auto at = [&](double t, double below, bool grip) {
      return scene::GripKey{t, {x, kPost_m[1], kPost_m[2] - kShort_m - below}, h == 0 && grip};
    };
    script.keys[h] = {at(0.5, 0.0, false), at(1.0, 0.0, true), at(2.0, pull_m, true), at(4.5, pull_m, true),
                      at(4.7, 0.0, false)};
  }
  return script;
}

std::vector<std::string> short_thread() {
  const auto at = [](double v) { return std::to_string(v); };
  return {"suture.initial=hanging", "suture.nodes=21", "suture.length_m=" + at(kShort_m), "suture.spacing=uniform",
          "world.fixed=[{node=0,position_m=[" + at(kPost_m[0]) + "," + at(kPost_m[1]) + "," + at(kPost_m[2]) + "]}]"};
}

}  // namespace ligature::lab
