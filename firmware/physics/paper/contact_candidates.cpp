#include <limits>
#include <tuple>

#include "firmware/physics/paper/contact.hpp"

// Search for candidates: pairs of bodies that may touch soon. The list is made with a margin, and the search is
// repeated only when the motion since then may have used up the margin.

namespace ligature::physics {
namespace {

bool same_bodies(const Candidate& a, const Candidate& b) noexcept {
  return a.kind == b.kind && a.first == b.first && a.second == b.second;
}
/// Order of the candidate list: pairs of segments, then obstacles one after the other, then the desk.
bool in_order(const Candidate& a, const Candidate& b) noexcept {
  const auto group = [](const Candidate& c) { return c.kind == Candidate::Kind::kObstacle ? c.second : 0; };
  return std::tuple(a.kind, group(a), a.first, a.second) < std::tuple(b.kind, group(b), b.first, b.second);
}

}  // namespace

void ContactSolver::keep(const ThreadState& state, Candidate c) noexcept {
  ContactRow unused;
  measure(state, c, unused);
  c.step = -1;  // measured from scratch: orient() may not assume on which side the bodies were before
  if (!(c.gap_m < margin_m_)) return;
  if (candidates_.size() < candidates_.capacity())
    candidates_.push_back(c);
  else
    report_.cap_hit = true;
}

/// Copies the impulses and measurements of candidates that were also in the old list. Both lists are sorted, so one
/// pass is enough.
void ContactSolver::inherit_impulses() noexcept {
  auto old = old_candidates_.begin();
  for (Candidate& c : candidates_) {
    while (old != old_candidates_.end() && in_order(*old, c)) ++old;
    if (old != old_candidates_.end() && same_bodies(*old, c)) c = *old;
  }
}

void ContactSolver::find_pairs(double reach_m) noexcept {
  switch (settings_.broad_phase) {
    case scene::BroadPhase::kSweep:
      return sweep_.find_pairs(spheres_, reach_m, settings_.skip, pairs_);
    case scene::BroadPhase::kBvh:
      return tree_.find_pairs(spheres_, reach_m, settings_.skip, pairs_);
    case scene::BroadPhase::kAuto:
    case scene::BroadPhase::kBrute:
      return find_pairs_brute(spheres_, reach_m, settings_.skip, pairs_);
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
  find_pairs(2.0 * radius_m_ + margin_m_);
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
  index_candidates();
  found_at_m_ = travel_m_;
}

/// Copies two numbers of each candidate into arrays, so that make_rows() can test four candidates at a time: its gap,
/// and due_m_, the value of travel_m_ up to which the candidate cannot touch.
void ContactSolver::index_candidates() noexcept {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const int count = static_cast<int>(candidates_.size());
  for (int k = 0; k < count; ++k) remember(k);
  for (int k = count; k < count + kLanes; ++k) due_m_[k] = gap_m_[k] = kNever;
}

void ContactSolver::remember(int k) noexcept {
  const Candidate& c = candidates_[static_cast<std::size_t>(k)];
  due_m_[k] = c.gap_m + c.travel_m;
  gap_m_[k] = c.kind == Candidate::Kind::kSegments ? c.gap_m : std::numeric_limits<double>::infinity();
}

}  // namespace ligature::physics
