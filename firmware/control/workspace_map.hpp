#pragma once
// Maps device coordinates D to world coordinates W. The scene may be larger than the device's workspace.

#include "firmware/control/kinematics.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::control {

/// World position p_WT = origin + scale (p_DT - p_DT_home) and world velocity v_WT = scale v_DT of the tip, whose
/// device position is p_DT. The axes of D and W are parallel, so forces need no rotation. Forces have another scale
/// (force_scale), so the map does not preserve energy.
struct WorkspaceMap {
  double scale = 1.0;
  Vec3 origin_W_m = Vec3::Zero();
  Vec3 home_DT_m = Vec3::Zero();

  WorkspaceMap(const scene::Hands& h, const Vec3& home_m)
      : scale(h.workspace_scale),
        origin_W_m(h.workspace_origin_m[0], h.workspace_origin_m[1], h.workspace_origin_m[2]),
        home_DT_m(home_m) {}

  [[nodiscard]] Vec3 position(const Vec3& p_DT_m) const noexcept { return origin_W_m + scale * (p_DT_m - home_DT_m); }
  [[nodiscard]] Vec3 velocity(const Vec3& v_DT_m_per_s) const noexcept { return scale * v_DT_m_per_s; }
};

}  // namespace ligature::control
