#pragma once
// Records the positions to which a seeing operator moves the hands, and turns them into a script that can be played
// without seeing.

#include <array>
#include <string>
#include <vector>

#include "protocol/scene/gripper_script.hpp"
#include "sim_device/operator/sight.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::lab {

class HandRecord {
 public:
  /// @param map maps world to device coordinates; positions out of the arm's reach are moved within it
  explicit HandRecord(const sim::WorkspaceMap& map) : map_(map) {}

  /// Call once a tick, in order of time. @param wish wanted position of each hand, without tremor. A position out of
  /// reach is moved towards the middle of the arm's range until it is within reach.
  void add(double t_s, const std::array<sim::HandWish, 2>& wish);

  /// The script: keys where the jaws open or close, at start and end, and as many between as a monotone cubic
  /// interpolation needs to pass every recorded position within `tolerance_m`.
  [[nodiscard]] scene::GripperScript script(double tolerance_m) const;

 private:
  [[nodiscard]] bool is_within_reach(const sim::Vec3& p_W) const;
  [[nodiscard]] sim::Vec3 written(const sim::Vec3& wish_W) const;

  sim::WorkspaceMap map_;
  std::array<std::vector<scene::GripKey>, 2> wishes_;
};

}  // namespace ligature::lab
