#include "sim_device/operator/thread_view.hpp"

#include <algorithm>
#include <limits>

namespace ligature::sim {

void ThreadView::look(std::span<const Vec3> nodes_W) {
  nodes_ = nodes_W;
  s_.resize(nodes_.size());
  s_[0] = 0.0;
  for (std::size_t i = 1; i < nodes_.size(); ++i) s_[i] = s_[i - 1] + (nodes_[i] - nodes_[i - 1]).norm();
}

std::size_t ThreadView::segment(double s) const noexcept {
  const auto after = std::upper_bound(s_.begin() + 1, s_.end() - 1, s);
  return static_cast<std::size_t>(after - s_.begin()) - 1;
}

Vec3 ThreadView::at(double s) const noexcept {
  const std::size_t k = segment(s);
  const double length = s_[k + 1] - s_[k];
  const double share = length > 0.0 ? std::clamp((s - s_[k]) / length, 0.0, 1.0) : 0.0;
  return nodes_[k] + share * (nodes_[k + 1] - nodes_[k]);
}

Vec3 ThreadView::along(double s) const noexcept {
  const std::size_t k = segment(s);
  return (nodes_[k + 1] - nodes_[k]).normalized();
}

double ThreadView::nearest(const Vec3& p, double first, double last) const noexcept {
  double least2 = std::numeric_limits<double>::infinity(), best = first;
  for (std::size_t k = segment(first); k + 1 < nodes_.size() && s_[k] <= last; ++k) {
    const Vec3 e = nodes_[k + 1] - nodes_[k];
    const double length = s_[k + 1] - s_[k];
    if (!(length > 0.0)) continue;
    const double share = std::clamp((p - nodes_[k]).dot(e) / (length * length), 0.0, 1.0);
    const double s = std::clamp(s_[k] + share * length, first, last);
    const double off2 = (at(s) - p).squaredNorm();
    if (off2 < least2) least2 = off2, best = s;
  }
  return best;
}

std::vector<Vec3> ThreadView::between(double first, double last) const {
  const double low = std::min(first, last), high = std::max(first, last);
  std::vector<Vec3> points{at(low)};
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (s_[k] > low && s_[k] < high) points.push_back(nodes_[k]);
  points.push_back(at(high));
  if (last < first) std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace ligature::sim
