#include "sim_device/script_hand.hpp"

#include <cstdio>
#include <utility>
#include <vector>

#include "sim_device/operator_path.hpp"

namespace ligature::sim {
namespace {

Vec3 vec(const scene::Vec& v) { return {v[0], v[1], v[2]}; }

/// Passes the keys without stopping, with the same cubics as the offline lab, in device coordinates. @pre at least one
/// key
class PassingHand final : public Intention {
 public:
  PassingHand(std::vector<scene::GripKey> keys_W, const WorkspaceMap& map) : keys_W_(std::move(keys_W)), map_(map) {}

  [[nodiscard]] Intent at(double t_s, const Touch&) const noexcept override {
    const auto pose = scene::sample(keys_W_, t_s);
    return {map_.to_device(vec(pose.p_W_m)), vec(pose.v_W_m_per_s) / map_.scale, pose.grip};
  }
  [[nodiscard]] double end_s() const noexcept override { return keys_W_.back().time_s; }
  [[nodiscard]] Vec3 start_D_m() const noexcept override { return map_.to_device(vec(keys_W_.front().p_W_m)); }

 private:
  std::vector<scene::GripKey> keys_W_;
  WorkspaceMap map_;
};

}  // namespace

std::string objection_to(const scene::GripKey& key, const WorkspaceMap& map) {
  const Vec3 p_D = map.to_device(vec(key.p_W_m));
  if (map.linkage.reaches(p_D)) return {};
  const Vec3 in_mm = map.to_device(1e-3 * vec(key.p_W_m));
  char line[300];
  std::snprintf(line, sizeof line,
                "key at time %g s lies at (%.3f, %.3f, %.3f) m for the device, out of its reach; "
                "allowed: hands.workspace_scale and workspace_origin_m that bring it nearer%s",
                key.time_s, p_D.x(), p_D.y(), p_D.z(),
                map.linkage.reaches(in_mm) ? ". Are the script's positions in mm? Their unit is m" : "");
  return line;
}

std::variant<std::unique_ptr<Intention>, std::string> script_hand(const scene::GripperScript& script, std::size_t hand,
                                                                  const WorkspaceMap& map) {
  const auto& keys = script.keys[hand];
  if (script.motion == scene::Motion::kMonotoneCubic && !keys.empty()) {
    for (const auto& key : keys)
      if (auto why = objection_to(key, map); !why.empty()) return why;
    return std::make_unique<PassingHand>(keys, map);
  }
  auto path = OperatorPath::make(keys, map);
  if (auto* why = std::get_if<std::string>(&path)) return std::move(*why);
  return std::make_unique<OperatorPath>(std::get<OperatorPath>(std::move(path)));
}

}  // namespace ligature::sim
