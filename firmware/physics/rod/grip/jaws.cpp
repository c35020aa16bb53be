#include "firmware/physics/rod/grip/jaws.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/physics/nearest_beside.hpp"

namespace ligature::physics::rod {
Place nearest_place(const State& state, int node, Vec p) noexcept {
  const auto position = [&](int i) { return state.x[i]; };
  const auto s = [&](int i) { return state.mesh.s[i]; };
  const auto nearest = nearest_beside(node, state.nodes(), position, p);
  return {s(node) + nearest.share * (s(nearest.next) - s(node)), nearest.x};
}

Place Jaws::would_hold(const Rod& rod, int node, Vec tool) const noexcept {
  if (settings_.width_m > 0.0) return nearest_place(rod.state(), node, tool);
  return {rod.state().mesh.s[node], rod.state().x[node]};
}

void Jaws::close(Rod& rod, int node, Vec tool, const Mat* R_WT) noexcept {
  const State& state = rod.state();
  const Vec chord = state.x[std::min(node + 1, state.nodes() - 1)] - state.x[std::max(node - 1, 0)];
  along_ = (1.0 / std::max(norm(chord), 1e-12)) * chord;
  s_m_ = would_hold(rod, node, tool).s_m;
  slides_m_per_s_ = 0.0;
  turning_ = R_WT != nullptr;
  roll_hold_ = -1;
  if (turning_) along_T_ = transposed(*R_WT) * along_;
  const bool directed = turning_ && settings_.width_m <= 0.0;  // with a width, several nodes define the direction
  const Vec target = tool + (state.mesh.s[node] - s_m_) * along_;
  hold_[0] = rod.grip(node, settings_.stiffness_N_per_m, settings_.damping_N_s_per_m, target, true, directed);
  count_ = hold_[0] >= 0 ? 1 : 0;
}

void Jaws::open(Rod& rod) noexcept {
  for (const int h : held()) rod.release(h);
  count_ = 0;
}

/// Releases nodes that are no longer between the jaws, and grips those that have come between them. One of the holds
/// always fixes the thread's roll.
void Jaws::choose(Rod& rod, Vec tool) noexcept {
  const State& state = rod.state();
  const auto& s = state.mesh.s;
  const auto n = static_cast<int>(s.size());
  const double half = 0.5 * settings_.width_m;
  if (s_m_ < -half || s_m_ > s.back() + half) return open(rod);
  int first = static_cast<int>(std::lower_bound(s.begin(), s.end(), s_m_ - half) - s.begin());
  int last = static_cast<int>(std::upper_bound(s.begin(), s.end(), s_m_ + half) - s.begin()) - 1;
  if (first > last) std::swap(first, last);  // no node between the jaws: the two nodes around s_c
  first = std::clamp(first, 0, n - 1), last = std::clamp(last, 0, n - 1);
  if (settings_.width_m <= 0.0) {
    const auto nearer = [&](int k) { return std::abs(s[k] - s_m_); };
    first = last = nearer(first) < nearer(last) ? first : last;
  } else if (first == last) {
    (last + 1 < n ? last : first) += last + 1 < n ? 1 : -1;
  }
  std::array<int, kMost> wanted{};
  const int inside = last - first + 1, most = std::min(inside, kMost);
  for (int k = 0; k < most; ++k) wanted[k] = most > 1 ? first + k * (inside - 1) / (most - 1) : first;
  const auto end = wanted.begin() + most;
  const auto leaves = [&](int hold) { return std::find(wanted.begin(), end, state.holds[hold].node) == end; };
  const auto let_go = [&](int* hold) {
    rod.release(*hold);
    *hold = hold_[--count_];
  };
  // One of the holds also fixes the roll. If that hold's node leaves the jaws, it is released last: first a new hold
  // takes over the roll, so that the thread keeps its twist.
  int* keeper = hold_.data();
  for (int* hold = hold_.data(); hold != hold_.data() + count_; ++hold)
    if (state.holds[*hold].holds_roll) keeper = hold;
  std::swap(*keeper, hold_[0]);
  const bool passes_on = leaves(hold_[0]);
  for (int* hold = hold_.data() + count_ - 1; hold != hold_.data(); --hold)
    if (passes_on || leaves(*hold)) let_go(hold);
  for (auto node = wanted.begin(); node != end && count_ < kMost; ++node) {
    if (state.is_held(*node)) continue;
    const Vec target = tool + (s[*node] - s_m_) * along_;
    const int h = rod.grip(*node, 0.0, 0.0, target, passes_on && count_ == 1);
    if (h >= 0) hold_[count_++] = h;
  }
  if (passes_on && count_ > 1) let_go(hold_.data());
  for (const int h : held()) {
    Hold& hold = rod.state().holds[h];
    hold.stiffness_N_per_m = settings_.stiffness_N_per_m / count_;
    hold.damping_N_s_per_m = settings_.damping_N_s_per_m / count_;
  }
}

/// Moves the jaws' centre s_c along the thread until the coupling's pull along the thread is at most slip_N.
void Jaws::slip(Rod& rod, Vec tool) noexcept {
  if (settings_.slip_N <= 0.0 || count_ == 0) return;
  const State& state = rod.state();
  double stretch_m = 0.0;  // mean distance of the nodes from their targets, along t
  for (const int h : held()) {
    const int node = state.holds[h].node;
    stretch_m += (dot(state.x[node] - tool, along_) - (state.mesh.s[node] - s_m_)) / count_;
  }
  const double most_m = settings_.slip_N / settings_.stiffness_N_per_m;
  const double over_m = stretch_m - std::clamp(stretch_m, -most_m, most_m);
  s_m_ -= over_m;
  slides_m_per_s_ = -over_m / rod.numerics().tick_s;
}

// Turns the held thread's direction, and its director (which fixes the roll), with the tool.
void Jaws::turn(Rod& rod, const Mat& R_WT) noexcept {
  along_ = R_WT * along_T_;
  for (const int h : held()) {
    const Hold& hold = rod.state().holds[h];
    if (!hold.holds_roll && !hold.directed) continue;
    if (h != roll_hold_) director_T_ = transposed(R_WT) * hold.director, roll_hold_ = h;
    rod.steer(h, R_WT * director_T_, along_);
  }
}

void Jaws::follow(Rod& rod, Vec tool, std::array<Vec, kMaxHolds>& goals, const Mat* R_WT) noexcept {
  if (count_ == 0) return;
  if (turning_ && R_WT != nullptr) turn(rod, *R_WT);
  if (settings_.width_m > 0.0 || settings_.slip_N > 0.0) {
    slip(rod, tool);
    choose(rod, tool);
  }
  for (const int h : held()) goals[h] = tool + (rod.state().mesh.s[rod.state().holds[h].node] - s_m_) * along_;
}

int Jaws::middle(const Rod& rod) const noexcept {
  const State& state = rod.state();
  return std::ranges::min(held(), {}, [&](int h) { return std::abs(state.mesh.s[state.holds[h].node] - s_m_); });
}

Vec Jaws::place(const Rod& rod) const noexcept {
  const State& state = rod.state();
  Vec mean{};
  for (const int h : held()) {
    const int node = state.holds[h].node;
    mean += (1.0 / count_) * (state.x[node] - (state.mesh.s[node] - s_m_) * along_);
  }
  return mean;
}

Vec Jaws::velocity(const Rod& rod) const noexcept {
  const State& state = rod.state();
  Vec mean = slides_m_per_s_ * along_;
  for (const int h : held()) mean += (1.0 / count_) * state.v[state.holds[h].node];
  return mean;
}

Vec Jaws::force(const Rod& rod) const noexcept {
  Vec sum{};
  for (const int h : held()) sum += rod.state().holds[h].force;
  return sum;
}

}  // namespace ligature::physics::rod
