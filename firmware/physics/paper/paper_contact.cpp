#include "firmware/physics/paper/paper_contact.hpp"

#include <limits>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/paper/friction.hpp"
#include "firmware/physics/paper/separation.hpp"

namespace ligature::physics {
namespace {
constexpr double kSafety =
    0.01;  // eps of the separation, in radii: the paper's "slight safety margin", for which it gives no value
}

PaperContact::PaperContact(const ThreadModel& model, const PaperContactSettings& settings)
    : settings_(settings), spheres_(model.nodes - 1) {
  pairs_.pairs.reserve(64 * static_cast<std::size_t>(model.nodes) + 256);
}

void PaperContact::respond(const ThreadModel& m, ThreadState& s, const SegmentPair& pair) noexcept {
  const int node[4] = {pair.first, pair.first + 1, pair.second, pair.second + 1};
  const auto near = closest(s.p.at(node[0]), s.p.at(node[1]), s.p.at(node[2]), s.p.at(node[3]));
  const double distance_m = root(near.distance2);
  min_gap_m_ = smaller(min_gap_m_, distance_m - 2.0 * m.radius_m);
  if (distance_m >= 2.0 * m.radius_m || !(distance_m > 0.0)) return;
  ++active_;
  const V3<double> n = (-1.0 / distance_m) * near.between;
  const Shares share = shares(near.s, near.t);
  const double part[4] = {share.a, share.b, share.c, share.d};
  double w[4], mobility = 0.0;
  V3<double> v{};
  for (int k = 0; k < 4; ++k) {
    w[k] = m.inverse_mass_per_kg[node[k]];
    mobility += part[k] * part[k] * w[k];
    v = v + part[k] * s.v.at(node[k]);
  }
  if (!(mobility > 0.0)) return;
  const double force = repulsion_N(settings_.repulsion, m.radius_m, distance_m, dot(v, n), settings_.capped);
  const double normal =
      bridson_impulse_N_s(settings_.capped ? force * m.step_s : magnitude(force) * m.step_s, near.s, near.t);
  const V3<double> friction = settings_.capped
                                  ? capped_friction_N_s(settings_.stick, settings_.slip, normal, 1.0 / mobility, v, n)
                                  : m.step_s * coulomb_friction_N(settings_.slip, force, v, n);
  const Shares shift =
      separating_shifts(separation_m(m.radius_m, distance_m, kSafety * m.radius_m), share, {w[0], w[1], w[2], w[3]});
  const double move[4] = {shift.a, shift.b, shift.c, shift.d};
  for (int k = 0; k < 4; ++k) {
    const V3<double> pushed = velocity_after(s.v.at(node[k]), part[k], normal, w[k], n);
    s.v.put(node[k], pushed + (part[k] * w[k]) * friction);
    s.p.put(node[k], s.p.at(node[k]) + move[k] * n);
  }
}

void PaperContact::solve(const ThreadModel& m, ThreadState& s) noexcept {
  active_ = 0;
  min_gap_m_ = std::numeric_limits<double>::infinity();
  spheres_.update(s.p);
  find_pairs_brute(spheres_, 2.0 * m.radius_m, settings_.skip, pairs_);
  for (const SegmentPair& pair : pairs_.pairs) respond(m, s, pair);
  extend_last_node(s.p, m.nodes);
}

}  // namespace ligature::physics
