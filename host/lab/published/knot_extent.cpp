#include "host/lab/published/knot_extent.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ligature::published {

using physics::rod::RodSimulation;

KnotExtent extent_of(const RodSimulation& sim) {
  const auto& contacts = sim.rod().contact_set().contacts();
  const auto& s = sim.rod().state().mesh.s;
  double most = 0.0;
  for (const auto& c : contacts) most = std::max(most, dot(c.p, c.n));
  std::vector<double> touched;
  for (const auto& c : contacts) {
    if (!c.is_pair() || dot(c.p, c.n) <= 0.01 * most) continue;
    for (const int k : {0, 2}) {  // nodes k and k + 1 are the ends of a segment, their weights the place on it
      const double w0 = std::abs(c.w[k]), w1 = std::abs(c.w[k + 1]);
      const double s0 = s[static_cast<std::size_t>(c.node[k])], s1 = s[static_cast<std::size_t>(c.node[k + 1])];
      touched.push_back((w0 * s0 + w1 * s1) / (w0 + w1));
    }
  }
  if (touched.empty()) return {};
  std::sort(touched.begin(), touched.end());
  std::size_t before = 0;  // the loop is the longest piece without a contact
  for (std::size_t k = 0; k + 1 < touched.size(); ++k) {
    if (touched[k + 1] - touched[k] > touched[before + 1] - touched[before]) before = k;
  }
  return {touched.front(), touched[before], touched[before + 1], touched.back()};
}

double normal_force_N(const RodSimulation& sim) {
  double sum = 0.0;
  for (const auto& c : sim.rod().contact_set().contacts()) sum += c.is_pair() ? dot(c.p, c.n) : 0.0;
  return sum * sim.rod().contact_set().per_second();
}

physics::Vec3 place_at(const RodSimulation& sim, double s_m) {
  const auto& s = sim.rod().state().mesh.s;
  const auto k = std::min(std::lower_bound(s.begin(), s.end(), s_m) - s.begin(), std::ssize(s) - 1);
  return sim.nodes_W()[static_cast<std::size_t>(k)];
}

}  // namespace ligature::published
