#include "firmware/physics/rod/model/twist.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ligature::physics::rod {
namespace {

// The director of hold `from`, parallel-transported along the centreline to hold `to`.
Vec carried(const State& state, const Hold& from, const Hold& to) noexcept {
  Vec u = from.director, t = from.tangent;
  for (int j = from.node; j < to.node; ++j) {
    const Vec e = edge(state, j);
    u = transport(u, t, e);
    t = e;
  }
  return transport(u, t, to.tangent);
}

const Hold& hold_of(const State& state, int k) noexcept { return state.holds[k]; }

}  // namespace

Vec tangent_at(const State& state, const Hold& hold) noexcept {
  if (hold.directed) return hold.direction;
  const auto i = static_cast<std::size_t>(hold.node);
  if (i == 0) return edge(state, 0);
  if (i + 1 == state.x.size()) return edge(state, i - 1);
  return unit(edge(state, i - 1) + edge(state, i));
}

double Twist::raw_turn(const State& state, int from, int to) const noexcept {
  const Hold& b = hold_of(state, to);
  return angle_about(b.tangent, carried(state, hold_of(state, from), b), b.director);
}

void Twist::roll(Hold& hold, double angle_rad) noexcept {
  hold.director = rolled(hold.director, hold.tangent, angle_rad);
}

void Twist::attach(State& state, int hold) noexcept {
  Hold& h = state.holds[hold];
  h.holds_roll = true;
  h.tangent = tangent_at(state, h);
  int k = 0;
  while (k < count_ && hold_of(state, order_[k]).node < h.node) ++k;
  const auto insert = [&](auto& array, auto value) {
    std::copy_backward(array.begin() + k, array.begin() + count_, array.begin() + count_ + 1);
    array[k] = value;
  };
  insert(order_, hold);
  insert(turn_, 0.0);
  ++count_;
  const Vec any = std::abs(h.tangent[0]) < 0.7 ? make(1, 0, 0) : make(0, 1, 0);
  h.director = unit(cross(h.tangent, any));
  if (k == 0 || k + 1 == count_) {  // first or last hold: the new span starts untwisted
    if (k > 0) h.director = carried(state, hold_of(state, order_[k - 1]), h), turn_[k - 1] = 0.0;
    if (k == 0 && count_ > 1) turn_[0] = raw_turn(state, order_[0], order_[1]), roll(h, turn_[0]), turn_[0] = 0.0;
    return;
  }
  const Hold& a = hold_of(state, order_[k - 1]);
  const Hold& b = hold_of(state, order_[k + 1]);
  const auto s = [&](const Hold& g) { return state.mesh.s[g.node]; };
  const double whole = turn_[k - 1], share = whole * (s(h) - s(a)) / (s(b) - s(a));
  h.director = carried(state, a, h);
  roll(h, share);
  turn_[k - 1] = share;
  turn_[k] = whole - share;
}

void Twist::detach(State& state, int hold) noexcept {
  state.holds[hold].holds_roll = false;
  int k = 0;
  while (k < count_ && order_[k] != hold) ++k;
  if (k == count_) return;
  if (k > 0) turn_[k - 1] += turn_[k];
  const auto erase = [&](auto& array) { std::copy(array.begin() + k + 1, array.begin() + count_, array.begin() + k); };
  erase(order_);
  erase(turn_);
  --count_;
}

void Twist::carry(State& state) const noexcept {
  for (int k = 0; k < count_; ++k) {
    Hold& h = state.holds[order_[k]];
    const Vec now = tangent_at(state, h);
    const Vec u = h.steered ? h.steer : transport(h.director, h.tangent, now);
    h.director = unit(u - dot(u, now) * now);
    h.tangent = now;
  }
}

void Twist::update(const Material& material, State& state, Forces& forces) noexcept {
  energy_J_ = 0.0;
  for (auto& m : forces.twist_moment) m = 0.0;
  carry(state);
  for (int k = 0; k + 1 < count_; ++k) {
    const double raw = raw_turn(state, order_[k], order_[k + 1]);
    turn_[k] += std::remainder(raw - turn_[k], 2.0 * std::numbers::pi);
    const int from = hold_of(state, order_[k]).node, to = hold_of(state, order_[k + 1]).node;
    const double span_m = state.mesh.s[to] - state.mesh.s[from];
    moment_[k] = material.GJ_N_m2 * turn_[k] / span_m;
    energy_J_ += 0.5 * moment_[k] * turn_[k];
    for (int i = from; i <= to; ++i) forces.twist_moment[i] = moment_[k];
  }
}

}  // namespace ligature::physics::rod
