// What displays show of a rod: tension, twist, contacts.

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/rod_simulation.hpp"

namespace ligature::physics::rod {
namespace {

Vec3 vec3(Vec a) noexcept { return {a[0], a[1], a[2]}; }

/// Point of a segment's chord at which a contact acts. A contact between smooth curves also has small weights on other
/// nodes, which are ignored here.
Vec3 place_on(const Contact& c, int first, const State& state) noexcept {
  const double w0 = std::abs(c.w[first]), w1 = std::abs(c.w[first + 1]);
  const Vec3 x0 = vec3(state.x[c.node[first]]);
  const Vec3 x1 = vec3(state.x[c.node[first + 1]]);
  return (w0 * x0 + w1 * x1) / (w0 + w1);
}

ContactPoint of_pair(const Contact& c, const State& state) noexcept {
  ContactPoint point;
  point.segment = c.node[0], point.other = c.node[2];
  point.normal_W = -vec3(c.n);  // n separates the second segment from the first
  point.f_W = -vec3(c.p);
  point.p_W = 0.5 * (place_on(c, 0, state) + place_on(c, 2, state));
  return point;
}

ContactPoint of_body(const Contact& c, const State& state, double radius_m) noexcept {
  ContactPoint point;
  point.segment = std::min(c.node[0], state.nodes() - 2);  // the desk touches nodes, also the last one
  point.normal_W = vec3(c.n);
  point.f_W = vec3(c.p);
  const Vec3 at = c.count == 1 ? vec3(state.x[c.node[0]]) : place_on(c, 0, state);
  point.p_W = at - radius_m * point.normal_W;
  return point;
}

}  // namespace

void RodSimulation::describe(std::span<float> tension_N, std::span<float> turn_rad) const noexcept {
  const auto& s = rod_.state().mesh.s;
  const Forces& forces = rod_.forces();
  const std::size_t edges = s.size() - 1;
  for (std::size_t i = 0; i < tension_N.size(); ++i)
    tension_N[i] = static_cast<float>(forces.tension[std::min(i, edges - 1)]);
  double turn = 0.0;
  for (std::size_t i = 0; i < turn_rad.size(); ++i) {
    turn_rad[i] = static_cast<float>(turn);
    // A segment is twisted only if both its ends have a twisting moment: beyond the last hold the thread turns freely
    const bool is_twisted = i < edges && forces.twist_moment[i] != 0.0 && forces.twist_moment[i + 1] != 0.0;
    if (is_twisted && rod_.material().GJ_N_m2 > 0.0)
      turn += forces.twist_moment[i] * (s[i + 1] - s[i]) / rod_.material().GJ_N_m2;
  }
}

std::size_t RodSimulation::contacts(std::span<ContactPoint> out) const noexcept {
  const auto& set = rod_.contact_set();
  std::size_t count = 0;
  for (const auto& c : set.contacts()) {
    if (count == out.size()) break;
    if (!(dot(c.p, c.n) > 0.0)) continue;
    ContactPoint& point = out[count++];
    point = c.is_pair() ? of_pair(c, rod_.state()) : of_body(c, rod_.state(), rod_.material().radius_m);
    point.f_W *= set.per_second();
    point.gap_m = c.gap_m;
  }
  return count;
}

}  // namespace ligature::physics::rod
