#include "host/lab/unknotting/pull.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/lab/validate/proceed.hpp"

namespace ligature::lab {
namespace {

using physics::Vec3;

knot::KnotResult knot_between(std::span<const Vec3> nodes_W, int first, int last) {
  std::vector<std::array<double, 3>> line;
  for (int k = first; k <= last; ++k) {
    const auto& p = nodes_W[static_cast<std::size_t>(k)];
    line.push_back({p.x(), p.y(), p.z()});
  }
  return knot::recognise(line, false);
}

double length_between(std::span<const Vec3> nodes_W, const Core& core) {
  double length_m = 0.0;
  for (int k = core.first + 1; k <= core.last; ++k) {
    length_m += (nodes_W[static_cast<std::size_t>(k)] - nodes_W[static_cast<std::size_t>(k - 1)]).norm();
  }
  return length_m;
}

}  // namespace

PullResult do_pull(physics::Simulation& thread, const scene::Scene& scene, const Pull& pull) {
  constexpr double kTake_s = 0.05, kHold_s = 1.0;
  const double pull_s = kPullLength_m / kPullSpeed_m_per_s, tick_s = scene.time.tick_s;
  const Vec3 from = thread.nodes_W()[static_cast<std::size_t>(pull.node)], to = from + kPullLength_m * pull.direction;
  const std::vector<scene::GripKey> keys{{0.0, {from.x(), from.y(), from.z()}, true},
                                         {kTake_s, {from.x(), from.y(), from.z()}, true},
                                         {kTake_s + pull_s, {to.x(), to.y(), to.z()}, true}};
  PullResult result;
  const physics::ToolInput away{Vec3(scene::kParked_W_m.data()), Vec3::Zero(), false};
  double t_s = 0.0;
  while (t_s < kTake_s + pull_s + kHold_s && result.finite) {
    const auto pose = scene::sample(keys, t_s);
    validate::proceed(thread, std::array{away, physics::ToolInput{Vec3(pose.p_W_m.data()),
                                                                  Vec3(pose.v_W_m_per_s.data()), pose.grip}});
    result.peak_N = std::max(result.peak_N, thread.hand(physics::Hand::kRight).f_W.norm());
    result.finite = thread.diagnostics().finite;
    t_s += tick_s;
  }
  result.knot = knot_of(thread);
  result.knot_size_m = result.knot.type == "0_1" ? 0.0 : length_between(thread.nodes_W(), core_of(thread.nodes_W()));
  return result;
}

physics::Simulation thread_of_shape(std::span<const Vec3> shape_W, const scene::Scene& scene) {
  auto thread = make_or_refuse(scene, "scene");
  thread.set_state(shape_W, {});
  return thread;
}

PullResult try_pull(std::span<const Vec3> shape_W, const scene::Scene& scene, const Pull& pull) {
  auto thread = thread_of_shape(shape_W, scene);
  return do_pull(thread, scene, pull);
}

Core core_of(std::span<const Vec3> nodes_W) {
  const int n = static_cast<int>(nodes_W.size());
  const auto whole = knot_between(nodes_W, 0, n - 1);
  if (whole.type == "0_1") return {};
  const auto keeps = [&](int first, int last) {
    return last - first >= 3 && knot_between(nodes_W, first, last).alexander == whole.alexander;
  };
  Core core{0, n - 1};
  // Cuts off one node at a time. Bisection would not do: a piece cut in the middle of the knot may contain a different
  // knot.
  for (;;) {
    if (keeps(core.first, core.last - 1)) {
      --core.last;
    } else if (keeps(core.first + 1, core.last)) {
      ++core.first;
    } else {
      return core;
    }
  }
}

std::span<const Vec3> six_directions() {
  static const std::array<Vec3, 6> kDirections{Vec3(1, 0, 0),  Vec3(-1, 0, 0), Vec3(0, 1, 0),
                                               Vec3(0, -1, 0), Vec3(0, 0, 1),  Vec3(0, 0, -1)};
  return kDirections;
}

const char* direction_name(std::size_t k) {
  constexpr const char* kNames[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  return kNames[k];
}

}  // namespace ligature::lab
