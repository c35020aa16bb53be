#include "sim_device/operator_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim_device/plant.hpp"
#include "sim_device/script_hand.hpp"

namespace ligature::sim {
namespace {

constexpr double kPeakVelocity = 1.5, kPeakAcceleration = 4.9, kPeakJerk = 180.0;  // in L/T, L/T², L/T³
// Enlarges these limits of a motion over a distance L in a time T, so that the fastest motion takes slightly less than
// T; ruckig then extends it to exactly T.
constexpr double kSlack = 1.005;
constexpr double kLeastTravel_m = 1e-4;  // an axis without motion still needs limits above zero

bool plan(const Vec3& from, const Vec3& to, double duration_s, ruckig::Trajectory<3>& trajectory) {
  ruckig::InputParameter<3> in;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double travel = std::max(std::abs(to[i] - from[i]), kLeastTravel_m) * kSlack;
    in.current_position[axis] = from[i];
    in.target_position[axis] = to[i];
    in.max_velocity[axis] = kPeakVelocity * travel / duration_s;
    in.max_acceleration[axis] = kPeakAcceleration * travel / (duration_s * duration_s);
    in.max_jerk[axis] = kPeakJerk * travel / (duration_s * duration_s * duration_s);
  }
  in.minimum_duration = duration_s;
  ruckig::Ruckig<3> planner;
  return planner.calculate(in, trajectory) == ruckig::Result::Working;
}

}  // namespace

std::variant<OperatorPath, std::string> OperatorPath::make(std::span<const scene::GripKey> keys,
                                                           const WorkspaceMap& map) {
  OperatorPath path;
  for (const scene::GripKey& key : keys) {
    if (auto why = objection_to(key, map); !why.empty()) return why;
    path.keys_.push_back({key.time_s, map.to_device({key.p_W_m[0], key.p_W_m[1], key.p_W_m[2]}), key.grip});
  }
  if (path.keys_.empty())
    path.keys_.push_back({0.0, map.linkage.home_D_m(), false});  // a hand without keys rests at home
  path.segments_.resize(path.keys_.size() - 1);
  for (std::size_t i = 0; i < path.segments_.size(); ++i) {
    const Key &from = path.keys_[i], &to = path.keys_[i + 1];
    if (!plan(from.p_D, to.p_D, to.time_s - from.time_s, path.segments_[i])) {
      char line[100];
      std::snprintf(line, sizeof line, "no jerk-limited motion from the key at %g s to that at %g s", from.time_s,
                    to.time_s);
      return line;
    }
  }
  return path;
}

Intent OperatorPath::at(double t_s) const noexcept {
  const auto after =
      std::upper_bound(keys_.begin(), keys_.end(), t_s, [](double t, const Key& k) { return t < k.time_s; });
  if (after == keys_.begin()) return {keys_.front().p_D, Vec3::Zero(), false};
  const Key& from = *(after - 1);
  if (after == keys_.end()) return {from.p_D, Vec3::Zero(), from.grip};
  std::array<double, 3> p{}, v{}, a{};
  segments_[static_cast<std::size_t>(after - keys_.begin() - 1)].at_time(t_s - from.time_s, p, v, a);
  return {Vec3{p[0], p[1], p[2]}, Vec3{v[0], v[1], v[2]}, from.grip};
}

}  // namespace ligature::sim
