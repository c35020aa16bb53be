#include <cmath>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/paper/contact.hpp"

// Narrow phase: gap, closest points and normal of a candidate, that is a pair of bodies that may touch soon.

namespace ligature::physics {
namespace {
constexpr double kRoundOff = 1e-9;  // in radii: centrelines closer than this do not define a normal
}

/// Sets the candidate's normal and gap. If the normal of two near centrelines has reversed within one step, the strands
/// have crossed: then the old normal is kept, and the overlap counts as deeper than a diameter.
void ContactSolver::orient(Candidate& c, const V3<double>& apart, double distance_m,
                           const V3<double>& axis) const noexcept {
  const bool fresh = c.step >= 0 && c.step + 1 >= step_;
  if (distance_m > kRoundOff * radius_m_) {
    const V3<double> n = (1.0 / distance_m) * apart;
    const bool crossed = fresh && distance_m < radius_m_ && c.gap_m < radius_m_ && dot(n, c.normal) < 0.0;
    if (!crossed) c.normal = n;
    c.gap_m = (crossed ? -distance_m : distance_m) - 2.0 * radius_m_;
  } else {
    if (!fresh) {
      const double size = norm(axis);
      c.normal = size > 0.0 ? (1.0 / size) * axis : V3<double>{0.0, 0.0, 1.0};
    }
    c.gap_m = -2.0 * radius_m_;
  }
  c.step = step_;
  c.travel_m = travel_m_;
}

/// Measures a candidate (two bodies that may touch soon). Sets the nodes and weights of its contact row, and the
/// obstacle's velocity.
void ContactSolver::measure(const ThreadState& s, Candidate& c, ContactRow& row) const noexcept {
  const int i = c.first, j = c.second, nobody = nodes_;
  if (c.kind == Candidate::Kind::kDesk) {
    // NOLINTNEXTLINE(bugprone-unchecked-optional-access): only a scene with a desk has such candidates
    c.gap_m = s.p.z[i] - *settings_.desk_m - radius_m_;
    c.normal = {0.0, 0.0, 1.0};
    c.step = step_;
    c.travel_m = travel_m_;
    row.node[0] = i, row.node[1] = row.node[2] = row.node[3] = nobody;
    row.weight[0] = 1.0, row.weight[1] = row.weight[2] = row.weight[3] = 0.0;
    row.v_outside = Pack{};
    return;
  }
  const bool outside = c.kind == Candidate::Kind::kObstacle;
  const Obstacle* o = outside ? &obstacles_[static_cast<std::size_t>(j)] : nullptr;
  const V3<double> p1 = s.p.at(i), q1 = s.p.at(i + 1);
  const V3<double> p2 = outside ? o->p0_m : s.p.at(j), q2 = outside ? o->p1_m : s.p.at(j + 1);
  const Closest<V3<double>> near = closest(p1, q1, p2, q2);
  orient(c, -near.between, root(near.distance2), cross(q1 - p1, q2 - p2));
  row.node[0] = i, row.node[1] = i + 1;
  row.weight[0] = 1.0 - near.s, row.weight[1] = near.s;
  row.node[2] = outside ? nobody : j, row.node[3] = outside ? nobody : j + 1;
  row.weight[2] = outside ? 0.0 : near.t - 1.0, row.weight[3] = outside ? 0.0 : -near.t;
  row.v_outside = outside ? to_pack(o->v_m_per_s) : Pack{};
}

std::size_t ContactSolver::points(const ThreadState& s, double step_s, std::span<ContactPoint> out) const noexcept {
  const auto vec3 = [](const V3<double>& a) { return Vec3(a.x, a.y, a.z); };
  // Contact point on the row's first body (body = 0) or second body (body = 2); the weights of the second one are
  // negative
  const auto place = [&](const ContactRow& row, std::size_t body) -> Vec3 {
    V3<double> sum{};
    for (std::size_t k = body; k < body + 2; ++k)
      if (row.weight[k] != 0.0) sum = sum + std::abs(row.weight[k]) * s.p.at(row.node[k]);
    return vec3(sum);
  };
  std::size_t count = 0;
  for (const ContactRow& row : rows_) {
    if (count == out.size()) break;
    if (!(dot3(row.impulse, row.impulse) > 0.0)) continue;
    const Candidate& c = candidates_[static_cast<std::size_t>(row.candidate)];
    const bool is_pair = c.kind == Candidate::Kind::kSegments;
    ContactPoint& point = out[count++];
    point.segment = c.first < nodes_ - 1 ? c.first : nodes_ - 2;  // the desk touches nodes, also the last one
    point.other = is_pair ? c.second : -1;
    point.normal_W = Vec3(row.normal[0], row.normal[1], row.normal[2]);
    point.f_W = Vec3(row.impulse[0], row.impulse[1], row.impulse[2]) / step_s;
    point.gap_m = c.gap_m;
    const Vec3 at = place(row, 0);
    point.p_W = is_pair ? Vec3(0.5 * (at + place(row, 2))) : Vec3(at - radius_m_ * point.normal_W);
  }
  return count;
}

}  // namespace ligature::physics
