#include "host/thread_knot.hpp"

namespace ligature::host {

std::vector<std::array<double, 3>> points_of(const ligature_msg::thread_t& thread) {
  std::vector<std::array<double, 3>> points;
  points.reserve(thread.p_W_m.size());
  for (const auto& p : thread.p_W_m) points.push_back({p[0], p[1], p[2]});
  return points;
}

knot::KnotResult name_knot(const ligature_msg::thread_t& thread) { return knot::recognise(points_of(thread), false); }

}  // namespace ligature::host
