#pragma once
// Map between world and device: p_WT = origin + scale (p_DT − p_DT_home); the axes of D and W are parallel.

#include "protocol/scene/scene.hpp"
#include "sim_device/kinematics.hpp"

namespace ligature::sim {

struct WorkspaceMap {
  double scale = 20.0;  ///< world metres per device metre, > 0
  Vec3 origin_W_m = Vec3::Zero();

  Linkage linkage{};

  explicit WorkspaceMap(const scene::Hands& hands, const Linkage& of_device = {})
      : scale(hands.workspace_scale),
        origin_W_m(hands.workspace_origin_m[0], hands.workspace_origin_m[1], hands.workspace_origin_m[2]),
        linkage(of_device) {}

  [[nodiscard]] Vec3 to_device(const Vec3& p_W) const noexcept {
    return linkage.home_D_m() + (p_W - origin_W_m) / scale;
  }
  [[nodiscard]] Vec3 to_world(const Vec3& p_D) const noexcept {
    return origin_W_m + scale * (p_D - linkage.home_D_m());
  }
};

}  // namespace ligature::sim
