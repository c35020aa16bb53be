#pragma once
// A thread described by arc length, so that an operator does not depend on the number of nodes.

#include <span>
#include <vector>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// A polyline as a curve. s is the arc length from the first node, m, in the present shape.
class ThreadView {
 public:
  /// Takes n >= 2 points. Stores only their arc lengths; the points must outlive this view. O(n).
  void look(std::span<const Vec3> nodes_W);

  [[nodiscard]] double length_m() const noexcept { return s_.back(); }
  /// at(): point at s; along(): unit tangent at s. s is clamped to the thread. O(log n).
  [[nodiscard]] Vec3 at(double s) const noexcept;
  [[nodiscard]] Vec3 along(double s) const noexcept;
  /// Arc length of the point nearest to p within first .. last. O(n).
  [[nodiscard]] double nearest(const Vec3& p, double first, double last) const noexcept;
  [[nodiscard]] double nearest(const Vec3& p) const noexcept { return nearest(p, 0.0, length_m()); }
  /// The curve from s = first to last as points, ends included; in reverse order if last < first.
  [[nodiscard]] std::vector<Vec3> between(double first, double last) const;

 private:
  [[nodiscard]] std::size_t segment(double s) const noexcept;

  std::span<const Vec3> nodes_;
  std::vector<double> s_{0.0, 0.0};
};

}  // namespace ligature::sim
