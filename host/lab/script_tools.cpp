#include "host/lab/script_tools.hpp"

#include <numbers>

namespace ligature::lab {
namespace {

physics::ToolInput tool_at(const scene::GripperScript& script, int hand, double t_s) {
  const auto pose = scene::sample(script.keys[hand], t_s);
  physics::ToolInput tool{physics::Vec3(pose.p_W_m.data()), physics::Vec3(pose.v_W_m_per_s.data()), pose.grip, {}};
  if (script.turns) {
    const physics::Vec3 turn = physics::Vec3(pose.turn_deg.data()) * (std::numbers::pi / 180.0);
    tool.R_WT = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized());
  }
  return tool;
}

}  // namespace

std::array<physics::ToolInput, 2> tools_at(const scene::GripperScript& script, double t_s) {
  return {tool_at(script, 0, t_s), tool_at(script, 1, t_s)};
}

double default_duration_s(const scene::GripperScript& script) {
  const double end_s = scene::end_time_s(script);
  return end_s > 0.0 ? end_s + 9.0 : 10.0;
}

}  // namespace ligature::lab
