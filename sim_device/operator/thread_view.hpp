#pragma once
// A thread by arc length: the only way an operator speaks about it, so that nothing depends on how many nodes it has.

#include <span>
#include <vector>

#include "sim_device/operator/sight.hpp"

namespace ligature::sim {

/// A polyline seen as a curve. s is arc length from the first node, m, along the shape as it is now.
class ThreadView {
 public:
  /// Looks at n >= 2 points. Copies nothing but the lengths; the points must outlive the view's use. O(n).
  void look(std::span<const Vec3> nodes_W);

  [[nodiscard]] double length_m() const noexcept { return s_.back(); }
  /// Point and unit tangent at s (clamped to the thread). O(log n).
  [[nodiscard]] Vec3 at(double s) const noexcept;
  [[nodiscard]] Vec3 along(double s) const noexcept;
  /// s of the point of first .. last nearest to p. O(n).
  [[nodiscard]] double nearest(const Vec3& p, double first, double last) const noexcept;
  [[nodiscard]] double nearest(const Vec3& p) const noexcept { return nearest(p, 0.0, length_m()); }
  /// The curve from s = first to last (or back, when last < first) as points, ends included.
  [[nodiscard]] std::vector<Vec3> between(double first, double last) const;

 private:
  [[nodiscard]] std::size_t segment(double s) const noexcept;

  std::span<const Vec3> nodes_;
  std::vector<double> s_{0.0, 0.0};
};

}  // namespace ligature::sim
