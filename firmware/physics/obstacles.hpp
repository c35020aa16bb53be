#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware/physics/contact.hpp"
#include "firmware/physics/grasp.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// What the thread meets in its world besides itself and the desk: two grippers and the hooks of the frame, all
/// capsules of the thread's own radius.
///   Gripper: from the tool tip 4 radii towards the person (-y). It does not touch the segments around the node it
///   holds. A hand that lets go is inside the thread, so its gripper touches nothing again until it has come clear.
///   Hook: from each fixed node 4 radii upwards (against gravity); it does not touch the segments around that node.
class ObstacleCourse {
 public:
  static constexpr std::size_t kMostHooks = ContactSolver::kObstacles - 2;

  /// Why there is no course for a scene, or empty: it has more hooks than the solver has room for.
  [[nodiscard]] static std::string objection(const scene::Scene& scene);

  ObstacleCourse() = default;
  /// @pre no objection.
  ObstacleCourse(const scene::Scene& scene, const ThreadModel& model, const ContactSettings& contact);

  /// Moves the grippers to the tools. Call once per tick, after the grasp.
  void update(const std::array<ToolInput, 2>& tools, const Grasp& grasp, const ThreadModel& model,
              const ThreadState& state, std::array<Obstacle, ContactSolver::kObstacles>& out) noexcept;
  void reset() noexcept { inside_ = {true, true}; }

 private:
  [[nodiscard]] bool is_clear(const Obstacle& o, const ThreadModel& model, const ThreadState& state) const noexcept;

  bool grippers_ = false;
  int skip_ = 2;
  std::array<bool, 2> inside_{true, true};  // an open gripper that still overlaps what it let go of
  std::vector<Obstacle> hooks_;
};

}  // namespace ligature::physics
