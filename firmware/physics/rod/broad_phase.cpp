#include "firmware/physics/rod/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/physics/rod/closest.hpp"

namespace ligature::physics::rod {
namespace {

constexpr std::size_t kBlock = 8;
constexpr float kSlack = 1.0001F;     // float rounding of centres and radii
constexpr std::size_t kTable = 2048;  // places for impulses: a few times the most contacts there can be

std::size_t place_of(std::int32_t a, std::int32_t b) noexcept {
  return (static_cast<std::size_t>(a) * 2654435761U + static_cast<std::size_t>(b) * 40503U) % kTable;
}

}  // namespace

void BroadPhase::reserve(int nodes, int pairs) {
  const auto n = (static_cast<std::size_t>(nodes) + 2 * kBlock) / kBlock * kBlock;
  for (auto* array : {&x_, &y_, &z_, &r_, &half_}) array->assign(n, 0.0F);
  blocks_.resize(n / kBlock);
  capacity_ = pairs;
  kept_.assign(kTable, Kept{});
}

// Spheres of segments and of blocks.
void BroadPhase::place(const State& state, const Motion& motion, float horizon_s) noexcept {
  const std::size_t segments = state.x.size() - 1, blocks = (segments + kBlock - 1) / kBlock;
  const Vec origin = state.x[0];  // floats are relative to the thread, so a far-away thread loses nothing
  for (std::size_t j = 0; j < blocks * kBlock; ++j) {
    if (j >= segments) {  // padding: far from everything
      x_[j] = y_[j] = z_[j] = 1e18F;
      r_[j] = half_[j] = 0.0F;
      continue;
    }
    const Vec mid = 0.5 * (state.x[j] + state.x[j + 1]) - origin, half = 0.5 * (state.x[j + 1] - state.x[j]);
    x_[j] = static_cast<float>(mid[0]);
    y_[j] = static_cast<float>(mid[1]);
    z_[j] = static_cast<float>(mid[2]);
    half_[j] = static_cast<float>(norm(half)) * kSlack;
    r_[j] = (half_[j] + horizon_s * static_cast<float>(motion.speed(j))) * kSlack;
  }
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t begin = k * kBlock, end = std::min(begin + kBlock, segments);
    Ball ball{0, 0, 0, 0};
    for (std::size_t j = begin; j < end; ++j) ball.x += x_[j], ball.y += y_[j], ball.z += z_[j];
    const float scale = 1.0F / static_cast<float>(end - begin);
    ball.x *= scale, ball.y *= scale, ball.z *= scale;
    for (std::size_t j = begin; j < end; ++j) {
      const float x = x_[j] - ball.x, y = y_[j] - ball.y, z = z_[j] - ball.z;
      ball.r = std::max(ball.r, std::sqrt(x * x + y * y + z * z) + r_[j]);
    }
    blocks_[k] = ball;
  }
}

void BroadPhase::keep_impulses(const std::vector<Candidate>& list) noexcept {
  for (auto& k : kept_) k.a = -1;
  std::size_t held = 0;
  for (const auto& c : list) {
    if (dot(c.impulse, c.impulse) == 0.0 || held + 1 >= kTable) continue;
    std::size_t at = place_of(c.a, c.b);
    while (kept_[at].a >= 0 && (kept_[at].a != c.a || kept_[at].b != c.b)) at = (at + 1) % kTable;
    if (kept_[at].a < 0) {
      kept_[at] = {c.a, c.b, c.impulse, c.stuck};
      ++held;
    } else {
      kept_[at].impulse += c.impulse;  // two, when their segments were merged
    }
  }
}

void BroadPhase::give_back(Candidate& pair) const noexcept {
  std::size_t at = place_of(pair.a, pair.b);
  while (kept_[at].a >= 0 && (kept_[at].a != pair.a || kept_[at].b != pair.b)) at = (at + 1) % kTable;
  if (kept_[at].a < 0) return;
  pair.impulse = kept_[at].impulse;
  pair.stuck = kept_[at].stuck;
}

bool BroadPhase::consider(const State& state, const Motion& motion, const Outlook& outlook, std::size_t a,
                          std::size_t b, std::vector<Candidate>& list) noexcept {
  if (b < a + 2) return true;
  spent_ += price::kConsider;
  const double d = outlook.diameter_m, arc = state.mesh.s[b] - state.mesh.s[a + 1];
  if (arc < kLeastArc * d) return true;
  const double reach = arc < 0.5 * std::numbers::pi * d ? d * std::sin(arc / d) : d;
  const double limit = reach + outlook.skin_m + outlook.horizon_s * motion.rate(a, b);
  const float dx = x_[b] - x_[a], dy = y_[b] - y_[a], dz = z_[b] - z_[a];
  const float within = (half_[a] + half_[b] + static_cast<float>(limit)) * kSlack;
  if (dx * dx + dy * dy + dz * dz > within * within) return true;  // allowed its own motion, it stays away
  spent_ += price::kList;
  const Closest c = closest(state.x[a], state.x[a + 1], state.x[b], state.x[b + 1]);
  if (c.distance2 > limit * limit) return true;
  if (static_cast<int>(list.size()) >= capacity_) return false;
  Candidate pair;
  pair.a = static_cast<std::int32_t>(a);
  pair.b = static_cast<std::int32_t>(b);
  pair.reach_m = reach;
  pair.due = std::sqrt(c.distance2) - reach;
  give_back(pair);
  list.push_back(pair);
  return true;
}

unsigned BroadPhase::near(std::size_t a, std::size_t q, float reach) const noexcept {
  const std::size_t base = q * kBlock;
  const float cx = blocks_[q].x - x_[a], cy = blocks_[q].y - y_[a], cz = blocks_[q].z - z_[a];
  const float within = blocks_[q].r * kSlack + r_[a] + reach;
  if (cx * cx + cy * cy + cz * cz > within * within) return 0;
  unsigned hits = 0;
  for (std::size_t l = 0; l < kBlock; ++l) {
    const float dx = x_[base + l] - x_[a], dy = y_[base + l] - y_[a], dz = z_[base + l] - z_[a];
    const float apart = r_[base + l] + r_[a] + reach;
    hits |= static_cast<unsigned>(dx * dx + dy * dy + dz * dz <= apart * apart) << l;
  }
  return hits;
}

bool BroadPhase::blocks(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p, std::size_t q,
                        std::vector<Candidate>& list) noexcept {
  constexpr long kDearest = price::kSphere + static_cast<long>(kBlock) * (price::kConsider + price::kList);
  const float reach = static_cast<float>(outlook.diameter_m + outlook.skin_m) * kSlack;
  for (std::size_t a = p * kBlock; a < std::min((p + 1) * kBlock, state.x.size() - 1); ++a) {
    if (spent_ + kDearest > allowance_) return false;
    spent_ += price::kSphere;
    for (unsigned hits = near(a, q, reach); hits != 0; hits &= hits - 1) {
      const std::size_t b = q * kBlock + static_cast<std::size_t>(__builtin_ctz(hits));
      if (!consider(state, motion, outlook, a, b, list)) return false;
    }
  }
  return true;
}

long BroadPhase::least_cost(int nodes) noexcept {
  const long blocks = (nodes + static_cast<long>(kBlock) - 1) / static_cast<long>(kBlock);
  return 4L * static_cast<long>(kTable) + 50L * nodes + 10L * blocks * (blocks + 1) / 2;
}

bool BroadPhase::build(const State& state, Motion& motion, const Outlook& outlook, long allowance, Work& work,
                       std::vector<Candidate>& list) noexcept {
  motion.restart();
  list.clear();
  place(state, motion, static_cast<float>(outlook.horizon_s));
  const std::size_t segments = state.x.size() - 1, count = (segments + kBlock - 1) / kBlock;
  const float reach = static_cast<float>(outlook.diameter_m + outlook.skin_m) * kSlack;
  spent_ = least_cost(state.nodes());
  allowance_ = allowance;
  bool good = true;
  for (std::size_t p = 0; p < count && good; ++p) {
    for (std::size_t q = p; q < count && good; ++q) {
      const float bx = blocks_[p].x - blocks_[q].x, by = blocks_[p].y - blocks_[q].y, bz = blocks_[p].z - blocks_[q].z;
      const float limit = (blocks_[p].r + blocks_[q].r) * kSlack + reach;
      if (p != q && bx * bx + by * by + bz * bz > limit * limit) continue;
      good = blocks(state, motion, outlook, p, q, list);
    }
  }
  work.spend(spent_);
  return good;
}

}  // namespace ligature::physics::rod
