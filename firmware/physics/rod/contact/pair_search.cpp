#include "firmware/physics/rod/contact/pair_search.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/four_segments.hpp"
#include "firmware/physics/rod/contact/smooth.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {
namespace {

// Factor against float rounding. Each coordinate of a sphere's centre has an error of 6e-8 of the thread's length. In a
// thread 1000 diameters long this makes an error of 2e-4 diameters in the distance of two centres. The factor covers
// that error, because no distance below 2.5 diameters is compared. In a longer thread the error makes the margin of the
// list (skin) smaller
constexpr float kSlack = 1.0001F;
constexpr std::size_t kLeastTable = 2048;

// Has a segment bending stiffness at one of its ends? Without bending stiffness the corners of the polygon are real,
// and contact is computed on the chord instead of on a smooth curve.
bool is_stiff(const Mesh& mesh, std::size_t j) noexcept { return mesh.weight[j] > 0.0 || mesh.weight[j + 1] > 0.0; }

}  // namespace

void BroadPhase::reserve(int nodes, int pairs) {
  const auto n = (static_cast<std::size_t>(nodes) + 2 * kBlock) / kBlock * kBlock;
  for (auto* array : {&x_, &y_, &z_, &half_, &bulge_}) array->assign(n, 0.0F);
  blocks_.resize(n / kBlock);
  for (int level = 0; level < kLevels; ++level) tree_[level].resize((n / kBlock >> level) + 1);
  capacity_ = pairs;
  // Room for an impulse of every pair, with at least half of the hash table empty
  places_.assign(std::max(kLeastTable, std::bit_ceil(2 * static_cast<std::size_t>(pairs))), kNobody);
  kept_.reserve(static_cast<std::size_t>(pairs));
}

/// Index of the pair in the hash table, or the free index for it.
std::size_t BroadPhase::place_of(std::int32_t a, std::int32_t b) const noexcept {
  const std::size_t mask = places_.size() - 1;
  std::size_t at = (static_cast<std::size_t>(a) * 2654435761U + static_cast<std::size_t>(b) * 40503U) & mask;
  for (; places_[at] != kNobody; at = (at + 1) & mask) {
    const Kept& k = kept_[places_[at]];
    if (k.a == a && k.b == b) break;
  }
  return at;
}

// Computes the bounding spheres of segments and blocks.
void BroadPhase::place(const State& state, const Motion& motion, float horizon_s) noexcept {
  const std::size_t segments = state.x.size() - 1, blocks = (segments + kBlock - 1) / kBlock;
  const Vec origin = state.x[0];  // coordinates relative to the thread keep float precision anywhere in the world
  for (std::size_t j = 0; j < blocks * kBlock; ++j) {
    if (j >= segments) {  // padding: far from everything
      x_[j] = y_[j] = z_[j] = 1e18F;
      half_[j] = bulge_[j] = 0.0F;
      continue;
    }
    const Vec mid = 0.5 * (state.x[j] + state.x[j + 1]) - origin, half = 0.5 * (state.x[j + 1] - state.x[j]);
    x_[j] = static_cast<float>(mid[0]);
    y_[j] = static_cast<float>(mid[1]);
    z_[j] = static_cast<float>(mid[2]);
    bulge_[j] = is_stiff(state.mesh, j) ? static_cast<float>(SmoothSegment(state, j, 1e9).bulge()) * kSlack : 0.0F;
    half_[j] = static_cast<float>(norm(half)) * kSlack;
  }
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t begin = k * kBlock, end = std::min(begin + kBlock, segments);
    Ball ball{0, 0, 0, 0};
    for (std::size_t j = begin; j < end; ++j) ball.x += x_[j], ball.y += y_[j], ball.z += z_[j];
    const float scale = 1.0F / static_cast<float>(end - begin);
    ball.x *= scale, ball.y *= scale, ball.z *= scale;
    for (std::size_t j = begin; j < end; ++j) {
      const float x = x_[j] - ball.x, y = y_[j] - ball.y, z = z_[j] - ball.z;
      ball.r = std::max(ball.r, (std::sqrt(x * x + y * y + z * z) + half_[j] + bulge_[j]) * kSlack);
    }
    blocks_[k] = tree_[0][k] = ball;
    tree_[0][k].r += horizon_s * static_cast<float>(motion.speed_of_block(k)) * kSlack;
  }
  grow_tree(blocks);
}

// Builds the tree of bounding spheres level by level. Each sphere encloses two spheres of the level below; its centre
// is midway between theirs.
void BroadPhase::grow_tree(std::size_t blocks) noexcept {
  for (int level = 1; level < kLevels && (blocks >> level) > 0; ++level) {
    const auto& below = tree_[level - 1];
    for (std::size_t k = 0; k < blocks >> level; ++k) {
      const Ball &a = below[2 * k], &b = below[2 * k + 1];
      const float x = 0.5F * (b.x - a.x), y = 0.5F * (b.y - a.y), z = 0.5F * (b.z - a.z);
      const float r = std::sqrt(x * x + y * y + z * z) + std::max(a.r, b.r);
      tree_[level][k] = {a.x + x, a.y + y, a.z + z, r * kSlack};
    }
  }
}

void BroadPhase::keep_impulses(const std::vector<Candidate>& list) noexcept {
  for (const Kept& k : kept_) places_[k.at] = kNobody;  // cheaper than clearing the whole table
  kept_.clear();
  for (const auto& c : list) {
    if (dot(c.impulse, c.impulse) == 0.0) continue;
    const std::size_t at = place_of(c.a, c.b);
    if (places_[at] == kNobody) {
      places_[at] = static_cast<std::uint32_t>(kept_.size());
      kept_.push_back({c.a, c.b, static_cast<std::uint32_t>(at), c.impulse, c.touch, c.stuck});
    } else {
      kept_[places_[at]].impulse += c.impulse;  // two pairs became one when their segments were merged
    }
  }
}

void BroadPhase::put_back(const PairList& list) const noexcept {
  list.pairs.clear();
  list.groups.clear();
  for (const Kept& k : kept_) {
    list.pairs.push_back({.a = k.a, .b = k.b, .touch = k.touch, .impulse = k.impulse, .stuck = k.stuck});
  }
}

void BroadPhase::give_back(Candidate& pair) const noexcept {
  const std::uint32_t found = places_[place_of(pair.a, pair.b)];
  if (found == kNobody) return;
  const Kept& k = kept_[found];
  pair.impulse = k.impulse;
  pair.touch = k.touch;
  pair.stuck = k.stuck;
}

void BroadPhase::consider(const State& state, const Motion& motion, const Outlook& outlook, std::size_t a,
                          std::size_t b) noexcept {
  spent_ += price::kConsider;
  const double d = outlook.diameter_m, arc = state.mesh.s[b] - state.mesh.s[a + 1];
  if (arc < kLeastArc * d) return;
  const bool along = arc < 0.5 * std::numbers::pi * d;  // neighbours along the thread
  const double reach = along ? d * std::sin(arc / d) : d;
  const auto cut = [&](std::size_t j) { return std::min(static_cast<double>(bulge_[j]), tuning.most_cut_d * d); };
  const double bulge = along ? 0.0 : cut(a) + cut(b);
  const double limit = reach + outlook.skin_m + outlook.horizon_s * motion.rate(a, b) + bulge;
  const float dx = x_[b] - x_[a], dy = y_[b] - y_[a], dz = z_[b] - z_[a];
  const float halves = half_[a] + half_[b], within = (halves + static_cast<float>(limit)) * kSlack;
  const float apart2 = dx * dx + dy * dy + dz * dz;
  if (apart2 > within * within) return;  // cannot touch within the horizon at the pair's relative speed
  spent_ += price::kList;
  const double near_m = std::min(outlook.near_m, 0.5 * (arc - reach));  // half the gap on a straight thread
  assert(close_count_ < close_.size());
  close_[close_count_++] = {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), reach, bulge, near_m, limit};
}

bool BroadPhase::list_close(const State& state, std::vector<Candidate>& list) noexcept {
  const std::size_t count = close_count_;
  for (std::size_t k = 0; k < count; k += 4) {
    std::array<std::size_t, 4> a{}, b{};
    for (std::size_t l = 0; l < 4; ++l) {
      const Close& close = close_[std::min(k + l, count - 1)];
      a[l] = static_cast<std::size_t>(close.a), b[l] = static_cast<std::size_t>(close.b);
    }
    const FourSegments first(a, state.x.data()), second(b, state.x.data());
    const Lanes distance = root(closest_along(first.e, second.e, second.x - first.x).distance2);
    for (std::size_t l = 0; l < std::min<std::size_t>(4, count - k); ++l) {
      const Close& close = close_[k + l];
      if (distance[l] > close.limit_m) continue;
      if (static_cast<int>(list.size()) >= capacity_) return false;
      list.push_back({.a = close.a,
                      .b = close.b,
                      .reach_m = close.reach_m,
                      .near_m = close.near_m,
                      .due = distance[l] - close.reach_m - close.bulge_m,
                      .bulge_m = close.bulge_m});
      give_back(list.back());
    }
  }
  return true;
}

unsigned BroadPhase::near(std::size_t a, std::size_t q, float reach) const noexcept {
  const std::size_t base = q * kBlock;
  const float cx = blocks_[q].x - x_[a], cy = blocks_[q].y - y_[a], cz = blocks_[q].z - z_[a];
  const float own = half_[a] + bulge_[a] + reach, within = blocks_[q].r + own;
  if (cx * cx + cy * cy + cz * cz > within * within) return 0;
  unsigned hits = 0;
  for (std::size_t l = 0; l < kBlock; ++l) {
    const float dx = x_[base + l] - x_[a], dy = y_[base + l] - y_[a], dz = z_[base + l] - z_[a];
    const float apart = half_[base + l] + bulge_[base + l] + own;
    hits |= static_cast<unsigned>(dx * dx + dy * dy + dz * dz <= apart * apart) << l;
  }
  // Only segments from a + 2 on count, so that each pair is found once and adjacent segments are left out
  return base < a + 2 ? hits & ~0U << (a + 2 - base) : hits;
}

bool BroadPhase::blocks(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p, std::size_t q,
                        const PairList& list) noexcept {
  constexpr long kDearest = price::kSphere + static_cast<long>(kBlock) * (price::kConsider + price::kList);
  const double rate = motion.rate_of_blocks(p, q);
  const auto reach =
      static_cast<float>(outlook.diameter_m + outlook.skin_m + outlook.horizon_s * rate) * kSlack * kSlack;
  const float x = blocks_[q].x - blocks_[p].x, y = blocks_[q].y - blocks_[p].y, z = blocks_[q].z - blocks_[p].z;
  const float within = blocks_[p].r + blocks_[q].r + reach;
  if (x * x + y * y + z * z > within * within) return true;
  // Excludes the padding of the last block. The padding is far away, but a thread that diverges (or has NaN) could
  // reach it
  const std::size_t left = state.x.size() - 1 - q * kBlock;
  const unsigned real = left >= kBlock ? ~0U : (1U << left) - 1U;
  const auto first = static_cast<std::int32_t>(list.pairs.size());
  close_count_ = 0;
  for (std::size_t a = p * kBlock; a < std::min((p + 1) * kBlock, state.x.size() - 1); ++a) {
    if (spent_ + kDearest > allowance_) return false;
    spent_ += price::kSphere;
    for (unsigned hits = near(a, q, reach) & real; hits != 0; hits &= hits - 1) {
      consider(state, motion, outlook, a, q * kBlock + static_cast<std::size_t>(__builtin_ctz(hits)));
    }
  }
  if (!list_close(state, list.pairs)) return false;
  const auto last = static_cast<std::int32_t>(list.pairs.size());
  if (last > first)
    list.groups.push_back(
        {.first = first, .last = last, .p = static_cast<std::int32_t>(p), .q = static_cast<std::int32_t>(q)});
  return true;
}

// For each block q, descends in the tree from the largest sphere whose first block is q. If a sphere is out of reach,
// all its blocks are skipped.
bool BroadPhase::search(const State& state, const Motion& motion, const Outlook& outlook, std::size_t p,
                        const PairList& list) noexcept {
  const std::size_t count = (state.x.size() - 1 + kBlock - 1) / kBlock;
  const Ball own = tree_[0][p];
  const float reach = static_cast<float>(outlook.diameter_m + outlook.skin_m) * kSlack;
  const auto meets = [&](const Ball& ball) {
    spent_ += price::kBall;
    const float x = ball.x - own.x, y = ball.y - own.y, z = ball.z - own.z, within = ball.r + own.r + reach;
    return x * x + y * y + z * z <= within * within;
  };
  for (std::size_t q = p; q < count;) {
    if (spent_ + kLevels * price::kBall > allowance_ || !has_time()) return false;
    int level = std::min(q == 0 ? kLevels - 1 : __builtin_ctzl(q), kLevels - 1);
    while (level > 0 && (q + (std::size_t{1} << level) > count || meets(tree_[level][q >> level]))) --level;
    if (level == 0 && meets(tree_[0][q]) && !blocks(state, motion, outlook, p, q, list)) return false;
    q += std::size_t{1} << level;
  }
  return true;
}

// Counted with callgrind for an overhand knot at 1 m/s: 133 instructions per node for the spheres and their tree, and
// 2100 in all to keep the impulses of the knot's contacts. For the latter, 5 instructions per entry of the smallest
// hash table are charged, which is enough for a tight knot too.
long BroadPhase::least_cost(int nodes) noexcept { return 5L * static_cast<long>(kLeastTable) + 155L * nodes; }

bool BroadPhase::build(const State& state, Motion& motion, const Outlook& outlook, long allowance, Work& work,
                       const PairList& list) noexcept {
  motion.restart();
  list.pairs.clear();
  list.groups.clear();
  place(state, motion, static_cast<float>(outlook.horizon_s));
  const std::size_t segments = state.x.size() - 1, count = (segments + kBlock - 1) / kBlock;
  spent_ = least_cost(state.nodes());
  asked_ = spent_ - Work::kPiece;  // so that the clock is queried first thing, after the O(n) part above
  allowance_ = allowance;
  time_ = &work.time();
  bool good = true;
  for (std::size_t p = 0; p < count && good; ++p) good = search(state, motion, outlook, p, list);
  work.spend(spent_);
  return good;
}

}  // namespace ligature::physics::rod
