#include "host/thread_knot.hpp"

namespace ligature::host {

knot::KnotResult name_knot(const ligature_msg::thread_t& thread) {
  std::vector<std::array<double, 3>> points;
  points.reserve(thread.p_W_m.size());
  for (const auto& p : thread.p_W_m) points.push_back({p[0], p[1], p[2]});
  return knot::recognise(points, false);
}

}  // namespace ligature::host
