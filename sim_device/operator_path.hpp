#pragma once
// What the operator's hand intends: through the key poses of a script, jerk-limited, at rest in every key.

#include <ruckig/ruckig.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/scene/gripper_script.hpp"
#include "sim_device/intention.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::sim {

/// Between two keys L metres and T seconds apart every axis has the limits v = 1.5 L/T, a = 4.9 L/T², j = 180 L/T³:
/// of all jerk-limited motions that take exactly T these come nearest to the smoothstep 3u² − 2u³ the offline lab moves
/// by (at most 2 % of L apart, on the same straight line), so that a script that ties a knot there ties it here.
class OperatorPath final : public Intention {
 public:
  /// Builds all segments; refused, with the key's time, when a key cannot be reached by the device.
  [[nodiscard]] static std::variant<OperatorPath, std::string> make(std::span<const scene::GripKey> keys,
                                                                    const WorkspaceMap& map);
  /// Intent at t_s after the script's start; held before the first key and after the last one.
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
  std::vector<Key> keys_;                        // at least one
  std::vector<ruckig::Trajectory<3>> segments_;  // segment i leads from key i to key i + 1
};

}  // namespace ligature::sim
