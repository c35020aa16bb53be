#include "firmware/physics/paper/propagation.hpp"

#include "firmware/physics/paper/banded.hpp"
#include "firmware/physics/paper/stretch_spring.hpp"

namespace ligature::physics {
namespace {
constexpr int kMostIterations = 40;
constexpr double kStiffer = 1e-12;  // added to the diagonal: a taut straight thread between fixed nodes is singular
// A correction that moves a node by more than kFar rest lengths, and by more than kOften times the sum of all
// violations, has nothing to do with them: Newton's method has found another shape of the thread, up to metres away.
// Pulls of tight knots at up to 5 m/s and 500 N move no node by more than 0.04 rest lengths.
constexpr double kFar = 0.25, kOften = 4.0;
}  // namespace

LengthLimits::LengthLimits(const ThreadModel& m, double min_length, double max_length)
    : rest_m_(m.rest_m),
      shortest_m_(min_length * m.rest_m),
      longest_m_(max_length * m.rest_m),
      step_s_(m.step_s),
      segments_(m.nodes - 1),
      u_(m.nodes),
      length_(m.nodes),
      diag_(m.nodes),
      gain_(m.nodes),
      link_(m.nodes),
      lambda_(m.nodes),
      impulse_(m.nodes),
      bound_(static_cast<std::size_t>(m.nodes), Bound::kInside),
      start_{Lane3(m.nodes), Lane3(m.nodes)} {}

void LengthLimits::forget() noexcept {
  for (int i = 0; i < segments_; ++i) impulse_[i] = 0.0;
  holding_ = false;
}

void LengthLimits::warm_start(const ThreadModel& m, ThreadState& s) noexcept {
  if (!holding_) return;
  for (int i = 0; i < m.nodes; i += kLanes) {
    const Pack w = m.inverse_mass_per_kg.pack(i), here = w * impulse_.pack(i), before = w * impulse_.pack(i - 1);
    s.v.set(i, s.v.pack(i) + here * u_.pack(i) - before * u_.pack(i - 1));
  }
}

/// Computes directions and lengths of all segments. @return the sum of the lengths, m, by which segments are outside
/// their limits; 0 if none is by more than the tolerance
double LengthLimits::measure(const ThreadModel& m, const ThreadState& s) noexcept {
  const Pack low = splat(shortest_m_ - kTolerance * rest_m_), high = splat(longest_m_ + kTolerance * rest_m_);
  double outside_m = 0.0;
  for (int i = 0; i < segments_; i += kLanes) {
    const auto seg = segment_of<Pack>(s.p.pack(i), s.p.pack(i + 1), splat(1e-9 * m.rest_m));
    u_.set(i, seg.u);
    length_.set(i, seg.length_m);
    const PackMask beyond = (seg.length_m > high) | (seg.length_m < low);
    if (!any(beyond)) continue;
    for (int k = 0; k < kLanes && i + k < segments_; ++k) {
      if (!beyond[k]) continue;
      const bool is_long = seg.length_m[k] > rest_m_;
      outside_m += is_long ? seg.length_m[k] - longest_m_ : shortest_m_ - seg.length_m[k];
      bound_[static_cast<std::size_t>(i) + static_cast<std::size_t>(k)] = is_long ? Bound::kLongest : Bound::kShortest;
    }
  }
  return outside_m;
}

void LengthLimits::remember(const ThreadModel& m, const ThreadState& s) noexcept {
  for (int i = 0; i < m.nodes; i += kLanes) {
    start_.p.set(i, s.p.pack(i));
    start_.v.set(i, s.v.pack(i));
  }
}

/// Has a node moved farther since remember() than the violations at that time, `outside_m` in all, can explain?
bool LengthLimits::is_far(const ThreadModel& m, const ThreadState& s, double outside_m) const noexcept {
  Pack farthest2 = splat(0.0);
  for (int i = 0; i < m.nodes; i += kLanes) {
    const V3<Pack> moved = s.p.pack(i) - start_.p.pack(i);
    farthest2 = larger(farthest2, dot(moved, moved));
  }
  const double far_m = larger(kFar * rest_m_, kOften * outside_m);
  return !(largest(farthest2) <= far_m * far_m);
}

/// Deactivates the limit of segment i if its total impulse has the wrong sign: a limit on the longest length can only
/// pull, one on the shortest length can only push.
void LengthLimits::let_go_of_pushed(int i) noexcept {
  Bound& bound = bound_[static_cast<std::size_t>(i)];
  const double total = impulse_[i] + lambda_[i] / step_s_;
  if ((bound == Bound::kLongest && total < 0.0) || (bound == Bound::kShortest && total > 0.0)) {
    lambda_[i] = -impulse_[i] * step_s_;
    bound = Bound::kInside;
  }
}

/// One Newton step: solves the tridiagonal system of all active limits and corrects positions and velocities.
void LengthLimits::correct(const ThreadModel& m, ThreadState& s) noexcept {
  const Lane& w = m.inverse_mass_per_kg;
  for (int i = 0; i < segments_; ++i) {
    const Bound bound = bound_[static_cast<std::size_t>(i)];
    const double mobility = w[i] + w[i + 1];
    const bool held = bound != Bound::kInside && mobility > 0.0;
    gain_[i] = held ? 1.0 : 0.0;
    diag_[i] = held ? mobility * (1.0 + kStiffer) : 1.0;
    lambda_[i] = held ? length_[i] - (bound == Bound::kLongest ? longest_m_ : shortest_m_) : 0.0;
    link_[i] = i > 0 ? w[i] * dot(u_.at(i - 1), u_.at(i)) : 0.0;
  }
  solve_tridiagonal(segments_, diag_.data(), gain_.data(), link_.data(), lambda_.data());
  for (int i = 0; i < segments_; ++i) {
    let_go_of_pushed(i);
    impulse_[i] += lambda_[i] / step_s_;
    const V3<double> push = lambda_[i] * u_.at(i);
    s.p.put(i, s.p.at(i) + w[i] * push);
    s.p.put(i + 1, s.p.at(i + 1) - w[i + 1] * push);
    s.v.put(i, s.v.at(i) + (w[i] / step_s_) * push);
    s.v.put(i + 1, s.v.at(i + 1) - (w[i + 1] / step_s_) * push);
  }
  extend_last_node(s.p, m.nodes);
}

/// Moves node `to` towards or away from node `from` until the segment's length is within its limits. Then removes the
/// part of the relative velocity that would violate the limit further, and no more, because a fallback must not add
/// energy.
void LengthLimits::place(const ThreadModel& m, ThreadState& s, int from, int to) noexcept {
  if (m.free[to] == 0.0) return;
  const V3<double> e = s.p.at(to) - s.p.at(from);
  const double length = norm(e);
  const double wanted = smaller(larger(length, shortest_m_), longest_m_);
  if (wanted == length) return;
  const V3<double> u = length > 0.0 ? (1.0 / length) * e : V3<double>{0.0, 0.0, -1.0};
  s.p.put(to, s.p.at(from) + wanted * u);
  const double rate = dot(u, s.v.at(to) - s.v.at(from));
  if ((rate > 0.0) == (length > wanted)) s.v.put(to, s.v.at(to) - rate * u);
}

/// Fallback if Newton's method does not converge, for instance because a hand jumps or two fixed nodes are too far
/// apart, or converges far away: enforces the limits node by node, outwards from the first fixed node.
void LengthLimits::walk_outwards(const ThreadModel& m, ThreadState& s) noexcept {
  int start = 0;
  while (start < segments_ && m.free[start] != 0.0) ++start;
  if (m.free[start] != 0.0) start = 0;
  for (int i = start; i < segments_; ++i) place(m, s, i, i + 1);
  for (int i = start; i > 0; --i) place(m, s, i, i - 1);
  extend_last_node(s.p, m.nodes);
}

int LengthLimits::enforce(const ThreadModel& m, ThreadState& s) noexcept {
  for (int i = 0; holding_ && i < segments_; ++i)
    bound_[static_cast<std::size_t>(i)] = impulse_[i] > 0.0   ? Bound::kLongest
                                          : impulse_[i] < 0.0 ? Bound::kShortest
                                                              : Bound::kInside;
  const double outside_m = measure(m, s);
  if (outside_m == 0.0 && !holding_) return 0;
  remember(m, s);
  int n = 0;
  bool is_outside = true;
  for (; n < kMostIterations && is_outside; ++n) {
    correct(m, s);
    is_outside = measure(m, s) > 0.0;
  }
  if (is_outside || is_far(m, s, outside_m)) {
    for (int i = 0; i < m.nodes; i += kLanes) s.p.set(i, start_.p.pack(i)), s.v.set(i, start_.v.pack(i));
    walk_outwards(m, s);
    forget();  // unconverged constraint forces would be a bad warm start
  }
  holding_ = false;
  for (int i = 0; i < segments_; ++i) {
    holding_ |= impulse_[i] != 0.0;
    bound_[static_cast<std::size_t>(i)] = Bound::kInside;
  }
  return n;
}

}  // namespace ligature::physics
