#pragma once
// What an operator sees and feels, and the commands for its hands. World frame W, SI units.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

namespace ligature::sim {

using Vec3 = Eigen::Vector3d;

inline constexpr std::size_t kLeftHand = 0, kRightHand = 1;

/// What the operator sees and feels at one moment: the thread as a polyline from its first node, and both tools.
struct Sight {
  double t_s = 0.0;
  std::span<const Vec3> thread_W;
  std::array<Vec3, 2> tool_W{Vec3::Zero(), Vec3::Zero()};
  /// Force felt by each hand, world newtons; 0: nothing held
  std::array<Vec3, 2> force_W_N{Vec3::Zero(), Vec3::Zero()};
  std::array<bool, 2> holds{true, true};  ///< whether thread is between the jaws; only meaningful for closed jaws
};

/// Commanded position and velocity of a tool, and whether its jaws close.
struct HandWish {
  Vec3 p_W = Vec3::Zero();
  Vec3 v_W = Vec3::Zero();
  bool grip = false;
};

}  // namespace ligature::sim
