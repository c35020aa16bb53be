#include "firmware/physics/rod/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ligature::physics::rod {
namespace {

constexpr int kBlock = 8;
constexpr float kSlack = 1.0001F;  // float rounding of centres and radii

}  // namespace

void BroadPhase::reserve(int nodes, int pairs) {
  const auto n = static_cast<std::size_t>((nodes + 2 * kBlock) / kBlock * kBlock);
  for (auto* array : {&x_, &y_, &z_, &r_}) array->assign(n, 0.0F);
  blocks_.resize(n / kBlock);
  capacity_ = pairs;
  old_.reserve(static_cast<std::size_t>(pairs));
}

bool BroadPhase::build(const State& state, double diameter_m, double margin_m, std::vector<Candidate>& list) noexcept {
  const auto& s = state.mesh.s;
  const std::size_t segments = s.size() - 1, blocks = (segments + kBlock - 1) / kBlock;
  const Vec origin = state.x[0];  // floats are relative to the thread, so a far-away thread loses nothing
  for (std::size_t j = 0; j < blocks * kBlock; ++j) {
    if (j >= segments) {  // padding: far from everything
      x_[j] = y_[j] = z_[j] = 1e18F;
      r_[j] = 0.0F;
      continue;
    }
    const Vec mid = 0.5 * (state.x[j] + state.x[j + 1]) - origin, half = 0.5 * (state.x[j + 1] - state.x[j]);
    x_[j] = static_cast<float>(mid[0]);
    y_[j] = static_cast<float>(mid[1]);
    z_[j] = static_cast<float>(mid[2]);
    r_[j] = static_cast<float>(norm(half)) * kSlack;
  }
  const float reach = static_cast<float>(diameter_m + margin_m) * kSlack;
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t begin = k * kBlock, end = std::min(begin + kBlock, segments);
    Ball ball{0, 0, 0, 0};
    for (std::size_t j = begin; j < end; ++j) ball.x += x_[j], ball.y += y_[j], ball.z += z_[j];
    const float scale = 1.0F / static_cast<float>(end - begin);
    ball.x *= scale, ball.y *= scale, ball.z *= scale;
    for (std::size_t j = begin; j < end; ++j) {
      ball.r = std::max(ball.r, std::hypot(x_[j] - ball.x, y_[j] - ball.y, z_[j] - ball.z) + r_[j]);
    }
    blocks_[k] = ball;
  }

  old_.clear();
  for (const auto& c : list) {
    if (dot(c.impulse, c.impulse) > 0.0) old_.push_back(c);
  }
  list.clear();
  bool room = true;
  const double close_arc = 0.6 * diameter_m, bent_arc = 0.5 * std::numbers::pi * diameter_m;
  const auto consider = [&](std::size_t a, std::size_t b) {
    if (b < a + 2) return;
    const double arc = s[b] - s[a + 1];
    if (arc < close_arc) return;
    if (static_cast<int>(list.size()) >= capacity_) {
      room = false;
      return;
    }
    Candidate c;
    c.a = static_cast<std::int32_t>(a);
    c.b = static_cast<std::int32_t>(b);
    c.reach_m = arc < bent_arc ? diameter_m * std::sin(arc / diameter_m) : diameter_m;
    c.due = -1e9;
    for (const auto& o : old_) {
      if (o.a == c.a && o.b == c.b) c.impulse += o.impulse;  // two, when their segments were merged
    }
    list.push_back(c);
  };
  for (std::size_t p = 0; p < blocks; ++p) {
    for (std::size_t q = p; q < blocks; ++q) {
      const float bx = blocks_[p].x - blocks_[q].x, by = blocks_[p].y - blocks_[q].y, bz = blocks_[p].z - blocks_[q].z;
      const float limit = (blocks_[p].r + blocks_[q].r) * kSlack + reach;
      if (p != q && bx * bx + by * by + bz * bz > limit * limit) continue;
      for (std::size_t a = p * kBlock; a < std::min((p + 1) * kBlock, segments); ++a) {
        const std::size_t base = q * kBlock;
        unsigned hits = 0;
        for (unsigned l = 0; l < kBlock; ++l) {
          const float dx = x_[base + l] - x_[a], dy = y_[base + l] - y_[a], dz = z_[base + l] - z_[a];
          const float near = r_[base + l] + r_[a] + reach;
          hits |= static_cast<unsigned>(dx * dx + dy * dy + dz * dz <= near * near) << l;
        }
        for (; hits != 0; hits &= hits - 1) consider(a, base + static_cast<std::size_t>(__builtin_ctz(hits)));
      }
    }
  }
  return room;
}

}  // namespace ligature::physics::rod
