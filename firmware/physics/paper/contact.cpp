#include "firmware/physics/paper/contact.hpp"

#include <limits>

// Contact rows of one step, solved by Gauss-Seidel sweeps.

namespace ligature::physics {
namespace {

constexpr int kFewestSweeps = 4, kMostSweeps = 40;
constexpr double kSettled = 1e-5;          // tolerance: change of a relative velocity per sweep, in radii per step
constexpr double kRecovery = 0.2;          // share of an overlap that is removed per step
constexpr double kFastestRecovery = 0.01;  // most overlap that is removed per step, in radii

}  // namespace

ContactSolver::ContactSolver(const ThreadModel& model, const ContactSettings& settings)
    : settings_(settings),
      radius_m_(model.radius_m),
      nodes_(model.nodes),
      spheres_(model.nodes - 1),
      sweep_(model.nodes - 1),
      tree_(model.nodes - 1) {
  const auto room = 24 * static_cast<std::size_t>(model.nodes) + 64;
  pairs_.pairs.reserve(4 * room);
  candidates_.reserve(room);
  old_candidates_.reserve(room);
  rows_.reserve(room);
  due_m_ = gap_m_ = Lane(static_cast<int>(room));
  velocity_.resize(static_cast<std::size_t>(model.nodes) + 1);
}

void ContactSolver::forget() noexcept {
  candidates_.clear();
  old_candidates_.clear();
  rows_.clear();
  margin_m_ = -1.0;
  report_ = {};
}

/// Makes a contact row for every candidate that could touch in the coming step. travel_m_ is an upper bound of how much
/// any gap has closed since the start of the run. So a gap that was measured when travel_m_ had the value t is now at
/// least gap + t - travel_m_. One comparison tests this for four candidates.
void ContactSolver::make_rows(const ThreadModel& m, const ThreadState& s, double near_m) noexcept {
  rows_.clear();
  const Pack limit = splat(near_m + travel_m_);
  Pack least = splat(std::numeric_limits<double>::infinity());
  for (int k = 0; k < static_cast<int>(candidates_.size()); k += kLanes) {
    const PackMask due = due_m_.pack(k) <= limit;
    if (any(due)) [[unlikely]] {
      for (int lane = 0; lane < kLanes; ++lane)
        if (due[lane]) try_row(m, s, near_m, k + lane);
    }
    least = smaller(least, gap_m_.pack(k));
  }
  report_.min_gap_m = smaller(smaller(least[0], least[1]), smaller(least[2], least[3]));
}

void ContactSolver::try_row(const ThreadModel& m, const ThreadState& s, double near_m, int k) noexcept {
  Candidate& c = candidates_[static_cast<std::size_t>(k)];
  if (c.kind == Candidate::Kind::kObstacle) {
    const Obstacle& o = obstacles_[static_cast<std::size_t>(c.second)];
    if (!o.present || (c.first >= o.skip_first && c.first <= o.skip_last)) return;
  }
  if (rows_.size() == rows_.capacity()) {
    report_.cap_hit = true;
    return;
  }
  ContactRow& row = rows_.emplace_back();
  measure(s, c, row);
  remember(k);
  row.candidate = k;
  if (c.gap_m <= near_m && finish_row(m, c, row)) return;
  c.impulse = Pack{};
  rows_.pop_back();
}

/// Sets masses, target velocity and starting impulse of a row whose gap was measured. @return false if no node of the
/// row can move
bool ContactSolver::finish_row(const ThreadModel& m, const Candidate& c, ContactRow& row) const noexcept {
  double mobility = 0.0;
  for (int e = 0; e < 4; ++e) {
    row.push[e] = row.weight[e] * m.inverse_mass_per_kg[row.node[e]];  // 0 for the immobile node
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

/// Upper bound of all speeds in the coming step, m/s. Also adds the obstacles' motion to travel_m_ (upper bound of how
/// much gaps have closed), and requests a new search for candidates if an obstacle has appeared or disappeared.
double ContactSolver::fastest(const ThreadState& s) noexcept {
  Pack speeds2 = splat(0.0);
  for (int i = 0; i < nodes_; i += kLanes) {
    const V3<Pack> v = s.v.pack(i);
    speeds2 = larger(speeds2, dot(v, v));
  }
  double fastest2 = largest(speeds2);
  for (std::size_t k = 0; k < kObstacles; ++k) {
    const Obstacle& o = obstacles_[k];
    if (o.present != known_[k].present) margin_m_ = -1.0;  // candidates must be found again
    if (o.present) {
      fastest2 = larger(fastest2, dot(o.v_m_per_s, o.v_m_per_s));
      travel_m_ += norm(o.p0_m - known_[k].p0_m);
    }
    known_[k] = o;
  }
  return std::sqrt(fastest2);
}

void ContactSolver::solve(const ThreadModel& m, ThreadState& s) noexcept {
  ++step_;
  report_.cap_hit = false;
  // How much a gap can close in this step at most, plus a margin, because contact impulses change velocities
  const double near_m = 2.0 * fastest(s) * m.step_s + 0.02 * radius_m_;
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
