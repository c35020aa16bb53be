#pragma once
// Intended motion of an operator's hand through the keys of a script: jerk-limited, at rest in every key.

#include <ruckig/ruckig.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/scene/gripper_script.hpp"
#include "sim_device/intention.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::sim {

/// For two keys L metres and T seconds apart, velocity, acceleration and jerk of every axis are limited to v = 1.5 L/T,
/// a = 4.9 L/T², j = 180 L/T³. Of all jerk-limited motions that take exactly T, these come closest to the smoothstep
/// 3u² − 2u³ of the offline lab (within 2 % of L, on the same straight line). So a script that ties a knot in the lab
/// also ties it here.
class OperatorPath final : public Intention {
 public:
  /// Plans all segments. @return the path, or an error with the key's time if the device cannot reach a key.
  [[nodiscard]] static std::variant<OperatorPath, std::string> make(std::span<const scene::GripKey> keys,
                                                                    const WorkspaceMap& map);
  /// Intent at t_s after the script's start; constant before the first and after the last key.
  [[nodiscard]] Intent at(double t_s) const noexcept;
  [[nodiscard]] Intent at(double t_s, const Touch&) const noexcept override { return at(t_s); }
  [[nodiscard]] double end_s() const noexcept override { return keys_.back().time_s; }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return keys_.front().p_D; }

 private:
  OperatorPath() = default;
  struct Key {
    double time_s;
    Vec3 p_D;
    bool grip;
  };
  std::vector<Key> keys_;                        // keys of the script, at least one
  std::vector<ruckig::Trajectory<3>> segments_;  // segment i leads from key i to key i + 1
};

}  // namespace ligature::sim
