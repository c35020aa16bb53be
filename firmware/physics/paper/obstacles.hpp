#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/contact.hpp"
#include "firmware/physics/paper/grasp.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// Obstacles of the thread: two grippers, and a hook at each fixed node. All are capsules with the thread's radius.
/// Gripper: it reaches from the tool's tip 4 radii towards the operator (-y). It has no contact with the segments
/// around the node that it holds. When a hand opens, its gripper overlaps the thread; so it has no contact at all until
/// it is clear of the thread.
/// Hook: it reaches from the fixed node 4 radii upwards (against gravity), and has no contact with the segments around
/// that node.
class ObstacleCourse {
 public:
  static constexpr std::size_t kMostHooks = ContactSolver::kObstacles - 2;

  /// Reason why the scene's obstacles cannot be simulated (more hooks than the solver has room for), or empty.
  [[nodiscard]] static std::string objection(const scene::Scene& scene);

  ObstacleCourse() = default;
  /// @pre objection(scene) is empty.
  ObstacleCourse(const scene::Scene& scene, const ThreadModel& model, const ContactSettings& contact);

  /// Moves the grippers to the tools. Call once per tick, after the grasp.
  void update(const std::array<ToolInput, 2>& tools, const Grasp& grasp, const ThreadModel& model,
              const ThreadState& state, std::array<Obstacle, ContactSolver::kObstacles>& out) noexcept;
  void reset() noexcept { inside_ = {true, true}; }
  LIGATURE_MEMBERS(ObstacleCourse, grippers, skip, inside, hooks)

 private:
  [[nodiscard]] bool is_clear(const Obstacle& o, const ThreadModel& model, const ThreadState& state) const noexcept;

  bool grippers_ = false;
  int skip_ = 2;
  std::array<bool, 2> inside_{true, true};  // gripper without contacts until it is clear of the thread
  std::vector<Obstacle> hooks_;
};

}  // namespace ligature::physics
