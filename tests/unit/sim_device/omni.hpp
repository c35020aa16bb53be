#pragma once
// The arm of the shipped haptic device (Omni class), and its place in the scene paper.toml.

#include <optional>

#include "sim_device/kinematics.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::sim {

[[nodiscard]] inline Vec3 home_tip_D_m() { return Linkage().home_D_m(); }
[[nodiscard]] inline Vec3 tip_D_m(const Vec3& q_rad) noexcept { return Linkage().tip_D_m(q_rad); }
[[nodiscard]] inline Mat3 tip_jacobian_D(const Vec3& q_rad) noexcept { return Linkage().jacobian_D(q_rad); }
[[nodiscard]] inline std::optional<Vec3> joints_of_tip(const Vec3& p_DT) noexcept { return Linkage().joints(p_DT); }

inline constexpr double kPaperScale = 20.0;

/// Map from the device's to the world's coordinates, as in scenes/paper.toml.
[[nodiscard]] inline WorkspaceMap paper_map() {
  scene::Hands hands;
  hands.workspace_scale = kPaperScale;
  hands.workspace_origin_m = {0.5, -0.4, 3.2};
  return WorkspaceMap(hands);
}

}  // namespace ligature::sim
