#include "firmware/physics/contact.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "firmware/physics/bend_geometry.hpp"
#include "firmware/physics/closest_points.hpp"

namespace ligature::physics {
namespace {

constexpr int kFewestSweeps = 4, kMostSweeps = 40;
constexpr double kSettled = 1e-5;       // of radius per step: a change of relative velocity too small to matter
constexpr double kRecovery = 0.2;       // share of an overlap that is undone per step ...
constexpr double kFastestRecovery = 0.01;  // ... but at most this many radii per step
constexpr double kRoundOff = 1e-9;      // of radius: centre lines this close have no direction from one to the other

bool same_bodies(const Candidate& a, const Candidate& b) noexcept {
  return a.kind == b.kind && a.first == b.first && a.second == b.second;
}
bool in_order(const Candidate& a, const Candidate& b) noexcept {
  return std::tuple(a.kind, a.second * (a.kind == Candidate::Kind::kObstacle), a.first, a.second) <
         std::tuple(b.kind, b.second * (b.kind == Candidate::Kind::kObstacle), b.first, b.second);
}

Pack to_pack(const V3<double>& a) noexcept { return Pack{a.x, a.y, a.z, 0.0}; }

}  // namespace

ContactSolver::ContactSolver(const ThreadModel& model, const ContactSettings& settings)
    : settings_(settings), radius_m_(model.radius_m), nodes_(model.nodes), spheres_(model.nodes - 1) {
  const auto room = static_cast<std::size_t>(24 * model.nodes + 64);
  pairs_.pairs.reserve(4 * room);
  candidates_.reserve(room);
  old_candidates_.reserve(room);
  rows_.reserve(room);
  velocity_.resize(static_cast<std::size_t>(model.nodes) + 1);
}

void ContactSolver::forget() noexcept {
  candidates_.clear();
  old_candidates_.clear();
  margin_m_ = -1.0;
  report_ = {};
}

/// Sets the candidate's normal and gap. Two centre lines that were near one step ago cannot have changed sides since
/// unless they went through each other: then the old side is kept and the overlap counted as deeper than a diameter.
void ContactSolver::orient(Candidate& c, const V3<double>& apart, double distance_m, const V3<double>& axis) const noexcept {
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

/// Measures a candidate and returns where its contact would be; weights and nodes only.
void ContactSolver::measure(const ThreadState& s, Candidate& c, ContactRow& row) const noexcept {
  const int i = c.first, j = c.second, nobody = nodes_;
  if (c.kind == Candidate::Kind::kDesk) {
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
  const ClosestPoints near = closest_points(p1, q1, p2, q2);
  orient(c, near.apart, near.distance_m, cross(q1 - p1, q2 - p2));
  row.node[0] = i, row.node[1] = i + 1;
  row.weight[0] = 1.0 - near.a, row.weight[1] = near.a;
  row.node[2] = outside ? nobody : j, row.node[3] = outside ? nobody : j + 1;
  row.weight[2] = outside ? 0.0 : near.b - 1.0, row.weight[3] = outside ? 0.0 : -near.b;
  row.v_outside = outside ? to_pack(o->v_m_per_s) : Pack{};
}

void ContactSolver::keep(const ThreadState& state, Candidate c) noexcept {
  ContactRow unused;
  measure(state, c, unused);
  c.step = -1;  // its side is known from now on, not from before
  if (!(c.gap_m < margin_m_)) return;
  if (candidates_.size() < candidates_.capacity())
    candidates_.push_back(c);
  else
    report_.cap_hit = true;
}

/// Both lists are in rising order, so memories are carried over in one pass.
void ContactSolver::inherit_impulses() noexcept {
  auto old = old_candidates_.begin();
  for (Candidate& c : candidates_) {
    while (old != old_candidates_.end() && in_order(*old, c)) ++old;
    if (old != old_candidates_.end() && same_bodies(*old, c)) c = *old;
  }
}

void ContactSolver::find_near_obstacle(const ThreadState& s, int k) noexcept {
  const Obstacle& o = obstacles_[static_cast<std::size_t>(k)];
  if (!o.present) return;
  find_near_sphere(spheres_, 0.5 * (o.p0_m + o.p1_m), 0.5 * norm(o.p1_m - o.p0_m), 2.0 * radius_m_ + margin_m_, pairs_);
  for (const SegmentPair& pair : pairs_.pairs) {
    Candidate c;
    c.kind = Candidate::Kind::kObstacle, c.first = pair.first, c.second = k;
    keep(s, c);
  }
}

void ContactSolver::find_candidates(const ThreadState& s) noexcept {
  std::swap(candidates_, old_candidates_);
  candidates_.clear();
  spheres_.update(s.p);
  find_pairs_brute(spheres_, 2.0 * radius_m_ + margin_m_, settings_.skip, pairs_);
  report_.cap_hit |= pairs_.overflow;
  for (const SegmentPair& pair : pairs_.pairs) {
    Candidate c;
    c.first = pair.first, c.second = pair.second;
    keep(s, c);
  }
  for (int k = 0; k < kObstacles; ++k) find_near_obstacle(s, k);
  for (int i = 0; settings_.desk_m && i < nodes_; ++i) {
    if (s.p.z[i] - *settings_.desk_m - radius_m_ >= margin_m_) continue;
    Candidate c;
    c.kind = Candidate::Kind::kDesk, c.first = i;
    keep(s, c);
  }
  inherit_impulses();
  found_at_m_ = travel_m_;
}

void ContactSolver::make_rows(const ThreadModel& m, const ThreadState& s, double near_m) noexcept {
  rows_.clear();
  report_.min_gap_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    Candidate& c = candidates_[k];
    const bool own = c.kind == Candidate::Kind::kSegments;
    if (own) report_.min_gap_m = smaller(report_.min_gap_m, c.gap_m);
    if (c.gap_m - (travel_m_ - c.travel_m) > near_m) continue;  // cannot have come close since it was last measured
    if (c.kind == Candidate::Kind::kObstacle) {
      const Obstacle& o = obstacles_[static_cast<std::size_t>(c.second)];
      if (!o.present || (c.first >= o.skip_first && c.first <= o.skip_last)) continue;
    }
    if (rows_.size() == rows_.capacity()) {
      report_.cap_hit = true;
      return;
    }
    ContactRow& row = rows_.emplace_back();
    measure(s, c, row);
    if (own) report_.min_gap_m = smaller(report_.min_gap_m, c.gap_m);
    if (c.gap_m > near_m || !finish_row(m, c, row)) {
      c.impulse = Pack{};
      rows_.pop_back();
      continue;
    }
    row.candidate = static_cast<int>(k);
  }
}

/// Masses, target and warm start of a measured row. @return whether anything in it can move
bool ContactSolver::finish_row(const ThreadModel& m, const Candidate& c, ContactRow& row) const noexcept {
  double mobility = 0.0;
  for (int e = 0; e < 4; ++e) {
    row.push[e] = row.weight[e] * m.inverse_mass_per_kg[row.node[e]];  // nobody is past the last node: 0
    mobility += row.push[e] * row.weight[e];
  }
  if (!(mobility > 0.0)) return false;
  row.mass_kg = 1.0 / mobility;
  row.normal = to_pack(c.normal);
  row.stick = settings_.stick, row.slip = settings_.slip;
  row.target_m_per_s = -c.gap_m / m.step_s;
  if (c.gap_m < 0.0) row.target_m_per_s = smaller(-kRecovery * c.gap_m, kFastestRecovery * radius_m_) / m.step_s;
  row.impulse = project_on_cone(c.impulse, row.normal, row.stick, row.slip);
  return true;
}

void ContactSolver::sweep(double step_s) noexcept {
  NodeVelocity* v = velocity_.data();
  for (const ContactRow& r : rows_)
    for (int k = 0; k < 4; ++k) v[r.node[k]].v += r.push[k] * r.impulse;
  report_.sweeps = 0;
  const double settled = kSettled * radius_m_ / step_s;
  for (int n = 0; n < kMostSweeps; ++n) {
    double change2 = 0.0;
    for (ContactRow& r : rows_) change2 = larger(change2, relax(r, v));
    report_.sweeps = n + 1;
    if (n + 1 >= kFewestSweeps && change2 < settled * settled) break;
  }
}

void ContactSolver::gather_velocities(const ThreadState& s) noexcept {
  for (const ContactRow& r : rows_)
    for (int k = 0; k < 4; ++k) velocity_[static_cast<std::size_t>(r.node[k])].v = to_pack(s.v.at(r.node[k]));
}

void ContactSolver::solve(const ThreadModel& m, ThreadState& s) noexcept {
  ++step_;
  report_.cap_hit = false;
  Pack speeds2 = splat(0.0);
  for (int i = 0; i < nodes_; i += kLanes) {
    const V3<Pack> v = s.v.pack(i);
    speeds2 = larger(speeds2, dot(v, v));
  }
  double fastest2 = largest(speeds2);
  for (std::size_t k = 0; k < kObstacles; ++k) {
    const Obstacle& o = obstacles_[k];
    if (o.present != known_[k].present) margin_m_ = -1.0;  // came or went: look for candidates anew
    if (o.present) {
      fastest2 = larger(fastest2, dot(o.v_m_per_s, o.v_m_per_s));
      travel_m_ += norm(o.p0_m - known_[k].p0_m);
    }
    known_[k] = o;
  }
  // Impulses may speed nodes up within the step, hence twice the way that the free motion could close.
  const double near_m = 2.0 * std::sqrt(fastest2) * m.step_s + 0.02 * radius_m_;
  if (margin_m_ < 0.0 || travel_m_ - found_at_m_ + near_m > margin_m_) {
    margin_m_ = radius_m_ + 4.0 * near_m;
    find_candidates(s);
  }
  make_rows(m, s, near_m);
  report_.active = 0;
  if (rows_.empty()) return;
  gather_velocities(s);
  sweep(m.step_s);
  for (const ContactRow& r : rows_) {
    candidates_[static_cast<std::size_t>(r.candidate)].impulse = r.impulse;
    if (dot3(r.impulse, r.impulse) > 0.0) ++report_.active;
    for (int k = 0; k < 4; ++k) {
      if (r.node[k] >= nodes_) continue;
      const Pack v = velocity_[static_cast<std::size_t>(r.node[k])].v;
      s.v.put(r.node[k], {v[0], v[1], v[2]});
    }
  }
}

}  // namespace ligature::physics
