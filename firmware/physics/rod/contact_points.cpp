#include "firmware/physics/rod/contact_points.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::physics {
namespace {

Vec3 vec3(rod::Vec a) noexcept { return {a[0], a[1], a[2]}; }

/// Point of a segment's chord at which a contact acts. A contact between smooth curves also has small weights on other
/// nodes, which are ignored here.
Vec3 place_on(const rod::Contact& c, int first, const rod::State& state) noexcept {
  const double w0 = std::abs(c.w[first]), w1 = std::abs(c.w[first + 1]);
  const Vec3 x0 = vec3(state.x[static_cast<std::size_t>(c.node[first])]);
  const Vec3 x1 = vec3(state.x[static_cast<std::size_t>(c.node[first + 1])]);
  return (w0 * x0 + w1 * x1) / (w0 + w1);
}

ContactPoint of_pair(const rod::Contact& c, const rod::State& state) noexcept {
  ContactPoint point;
  point.segment = c.node[0], point.other = c.node[2];
  point.normal_W = -vec3(c.n);  // n separates the second segment from the first
  point.f_W = -vec3(c.p);
  point.p_W = 0.5 * (place_on(c, 0, state) + place_on(c, 2, state));
  return point;
}

ContactPoint of_body(const rod::Contact& c, const rod::State& state, double radius_m) noexcept {
  ContactPoint point;
  point.segment = std::min(c.node[0], state.nodes() - 2);  // the desk touches nodes, also the last one
  point.normal_W = vec3(c.n);
  point.f_W = vec3(c.p);
  const Vec3 at = c.count == 1 ? vec3(state.x[static_cast<std::size_t>(c.node[0])]) : place_on(c, 0, state);
  point.p_W = at - radius_m * point.normal_W;
  return point;
}

}  // namespace

std::size_t rod_contacts(const rod::Rod& rod, std::span<ContactPoint> out) noexcept {
  const auto& set = rod.contact_set();
  std::size_t count = 0;
  for (const auto& c : set.contacts()) {
    if (count == out.size()) break;
    if (!(dot(c.p, c.n) > 0.0)) continue;
    ContactPoint& point = out[count++];
    point = c.is_pair() ? of_pair(c, rod.state()) : of_body(c, rod.state(), rod.material().radius_m);
    point.f_W *= set.per_second();
    point.gap_m = c.gap_m;
  }
  return count;
}

}  // namespace ligature::physics
