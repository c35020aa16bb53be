#pragma once
// Where a point of the world lies for the device: p_WT = origin + scale (p_DT − p_DT_home), axes of D and W parallel.

#include "protocol/scene/scene.hpp"
#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct WorkspaceMap {
  double scale = 20.0;  ///< world metres per device metre, > 0
  Vec3 origin_W_m = Vec3::Zero();

  explicit WorkspaceMap(const scene::Hands& hands)
      : scale(hands.workspace_scale),
        origin_W_m(hands.workspace_origin_m[0], hands.workspace_origin_m[1], hands.workspace_origin_m[2]) {}

  [[nodiscard]] Vec3 to_device(const Vec3& p_W) const noexcept { return home_tip_D_m() + (p_W - origin_W_m) / scale; }
  [[nodiscard]] Vec3 to_world(const Vec3& p_D) const noexcept { return origin_W_m + scale * (p_D - home_tip_D_m()); }
};

}  // namespace ligature::sim
