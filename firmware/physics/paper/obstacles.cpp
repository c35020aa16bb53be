#include "firmware/physics/paper/obstacles.hpp"

#include <algorithm>

#include "firmware/physics/closest.hpp"

namespace ligature::physics {
namespace {
constexpr double kReach = 4.0;  // length of grippers and hooks, in radii

V3<double> gravity_of(const scene::Scene& scene) noexcept {
  const auto& g = scene.world.gravity_m_per_s2;
  return {g[0], g[1], g[2]};
}

/// Hooks point against gravity, so there are none without it.
bool has_hooks(const scene::Scene& scene) noexcept {
  return scene.world.frame_collides && norm(gravity_of(scene)) > 0.0;
}

}  // namespace

std::string ObstacleCourse::objection(const scene::Scene& scene) {
  if (!has_hooks(scene) || scene.world.fixed.size() <= kMostHooks) return {};
  return "world.fixed: found " + std::to_string(scene.world.fixed.size()) + ", allowed " + std::to_string(kMostHooks) +
         " with hooks (world.frame_collides = false lifts that)";
}

ObstacleCourse::ObstacleCourse(const scene::Scene& scene, const ThreadModel& m, const ContactSettings& contact)
    : grippers_(scene.world.grippers_collide), skip_(contact.skip) {
  if (!has_hooks(scene)) return;
  const V3<double> down = gravity_of(scene);
  const double weight = norm(down);
  for (const scene::FixedNode& f : scene.world.fixed) {
    const int node = f.node < 0 ? m.nodes - 1 : f.node;
    Obstacle hook;
    hook.p0_m = {f.position_m[0], f.position_m[1], f.position_m[2]};
    hook.p1_m = hook.p0_m - (kReach * m.radius_m / weight) * down;
    hook.skip_first = node - skip_, hook.skip_last = node + skip_ - 1;
    hook.present = true;
    hooks_.push_back(hook);
  }
}

bool ObstacleCourse::is_clear(const Obstacle& o, const ThreadModel& m, const ThreadState& s) const noexcept {
  for (int i = 0; i < m.nodes - 1; ++i)
    if (root(closest(s.p.at(i), s.p.at(i + 1), o.p0_m, o.p1_m).distance2) < 2.0 * m.radius_m) return false;
  return true;
}

void ObstacleCourse::update(const std::array<ToolInput, 2>& tools, const Grasp& grasp, const ThreadModel& m,
                            const ThreadState& s, std::array<Obstacle, ContactSolver::kObstacles>& out) noexcept {
  std::copy(hooks_.begin(), hooks_.end(), out.begin() + 2);
  for (std::size_t h = 0; grippers_ && h < 2; ++h) {
    Obstacle& o = out[h];
    const ToolInput& tool = tools[h];
    o.p0_m = {tool.p_WT.x(), tool.p_WT.y(), tool.p_WT.z()};
    o.p1_m = o.p0_m + V3<double>{0.0, -kReach * m.radius_m, 0.0};
    o.v_m_per_s = {tool.v_WT.x(), tool.v_WT.y(), tool.v_WT.z()};
    const int node = grasp.node(static_cast<int>(h));
    o.skip_first = node - skip_, o.skip_last = node < 0 ? -1 : node + skip_ - 1;
    if (node >= 0)
      inside_[h] = true;
    else if (inside_[h])
      inside_[h] = !is_clear(o, m, s);
    o.present = node >= 0 || !inside_[h];
  }
}

}  // namespace ligature::physics
