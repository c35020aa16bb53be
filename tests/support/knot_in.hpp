#pragma once
// The knot in a simulated thread.

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "host/knot/recognise.hpp"

namespace ligature::test {

/// The knot of an open thread. @param thread_m  its nodes
inline knot::KnotResult recognised(std::span<const Eigen::Vector3d> thread_m) {
  std::vector<std::array<double, 3>> points;
  for (const auto& p : thread_m) points.push_back({p.x(), p.y(), p.z()});
  return knot::recognise(points, false);
}

/// Type and handedness of that knot, such as "3_1 right".
inline std::string knot_in(std::span<const Eigen::Vector3d> thread_m) {
  const auto found = recognised(thread_m);
  return found.type + " " + found.handedness;
}

}  // namespace ligature::test
