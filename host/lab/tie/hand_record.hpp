#pragma once
// What both hands wanted while they tied, as a script that a device plays without looking.

#include <array>
#include <string>
#include <vector>

#include "protocol/scene/gripper_script.hpp"
#include "sim_device/operator/sight.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::lab {

class HandRecord {
 public:
  /// @param map where the arm is in the world: what it cannot reach is not written
  explicit HandRecord(const sim::WorkspaceMap& map) : map_(map) {}

  /// Once a tick, in order of time. @param wish of a hand without its tremor. A wish out of the arm's reach is drawn
  /// back, towards the middle of its reach, until it can be reached.
  void add(double t_s, const std::array<sim::HandWish, 2>& wish);

  /// Keys where the jaws open or close, at both ends, and as many between as a monotone cubic needs to pass within
  /// `tolerance_m` of every wish.
  [[nodiscard]] scene::GripperScript script(double tolerance_m) const;

 private:
  [[nodiscard]] bool is_within_reach(const sim::Vec3& p_W) const;
  [[nodiscard]] sim::Vec3 written(const sim::Vec3& wish_W) const;

  sim::WorkspaceMap map_;
  std::array<std::vector<scene::GripKey>, 2> wishes_;
};

}  // namespace ligature::lab
