#pragma once
// Plays a gripper script into a simulation and checks the knot; shared by the tests of tying, pulling and releasing.

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "host/knot/recognise.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::physics::test {

inline scene::Scene paper_scene(const std::vector<std::string>& overrides = {}) {
  auto loaded = scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/paper.toml", overrides);
  if (auto* error = std::get_if<scene::Error>(&loaded)) throw std::runtime_error(error->text);
  return std::get<scene::Scene>(loaded);
}

inline Simulation make(const scene::Scene& scene) {
  auto made = Simulation::make(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::move(std::get<Simulation>(made));
}

inline scene::GripperScript overhand() {
  auto loaded = scene::load_gripper_script(LIGATURE_SOURCE_DIR "/scenes/operators/overhand.csv");
  if (auto* error = std::get_if<scene::Error>(&loaded)) throw std::runtime_error(error->text);
  return std::get<scene::GripperScript>(loaded);
}

inline knot::KnotResult knot_of(const Simulation& sim) {
  std::vector<std::array<double, 3>> points;
  for (const Vec3& p : sim.nodes_W()) points.push_back({p.x(), p.y(), p.z()});
  return knot::recognise(points, false);
}

/// Changes applied to a script when it is played.
struct Variation {
  double speed = 1.0;     ///< time scale; 1.25 is a quarter faster
  double turn_rad = 0.0;  ///< about the vertical
  bool mirrored = false;  ///< y -> -y
};

inline ToolInput tool_at(const std::vector<scene::GripKey>& keys, double t_s, const Variation& how = {}) {
  const scene::ToolPose pose = scene::sample(keys, t_s * how.speed);
  const auto moved = [&how](const scene::Vec& a) {
    const double y = how.mirrored ? -a[1] : a[1], c = std::cos(how.turn_rad), s = std::sin(how.turn_rad);
    return Vec3(c * a[0] - s * y, s * a[0] + c * y, a[2]);
  };
  return {moved(pose.p_W_m), how.speed * moved(pose.v_W_m_per_s), pose.grip};
}

/// Plays the script from t = from to t = to in ticks of 1 ms.
inline void play(Simulation& sim, const scene::GripperScript& script, double from_s, double to_s,
                 const Variation& how = {}) {
  for (int k = static_cast<int>(std::lround(from_s * 1000)); k < static_cast<int>(std::lround(to_s * 1000)); ++k) {
    const double t = (k + 1) * 1e-3;
    sim.tick({tool_at(script.keys[0], t, how), tool_at(script.keys[1], t, how)});
  }
}

}  // namespace ligature::physics::test
