#include "firmware/physics/rod/solve/mixing.hpp"

#include <algorithm>

namespace ligature::physics::rod {
namespace {

constexpr double kRidge = 1e-6,
                 kLeast = 1e-14;  // regularisation added to the diagonal: relative to its entry, to the trace

using Row = std::array<double, Mixing::kDepth>;

// Solves a small symmetric positive definite system by Gaussian elimination, in place; b becomes the solution.
void solve(std::array<Row, Mixing::kDepth>& a, Row& b, std::size_t n) noexcept {
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const double f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
}

double sum(Lanes a) noexcept { return (a[0] + a[1]) + a[2]; }

}  // namespace

// Stores the newest changes dr, dp in `slot`. The same pass over the impulses computes two sets of dot products: of the
// new dr with all stored dr (products_), and of all stored dr with r (theta).
void Mixing::measure(const Vec* p, const Vec* r, std::size_t impulses, std::size_t slot, Row& theta) noexcept {
  Lanes g0{}, g1{}, g2{}, g3{}, b0{}, b1{}, b2{}, b3{};
  for (std::size_t i = 0; i < impulses; ++i) {
    Past& past = past_[i];
    const Lanes now = r[i].v, d = now - past.r.v;
    past.dr[slot].v = d;
    past.dp[slot].v = p[i].v - past.p.v;
    past.r.v = now;
    past.p.v = p[i].v;
    const Lanes d0 = past.dr[0].v, d1 = past.dr[1].v, d2 = past.dr[2].v, d3 = past.dr[3].v;
    g0 += d * d0, g1 += d * d1, g2 += d * d2, g3 += d * d3;
    b0 += now * d0, b1 += now * d1, b2 += now * d2, b3 += now * d3;
  }
  const Row row{sum(g0), sum(g1), sum(g2), sum(g3)};
  for (std::size_t k = 0; k < kDepth; ++k) products_[slot][k] = products_[k][slot] = row[k];
  theta = {sum(b0), sum(b1), sum(b2), sum(b3)};
}

bool Mixing::step(Vec* p, const Vec* r, std::size_t impulses) noexcept {
  if (!primed_) known_ = 0;
  for (; known_ < impulses; ++known_) past_[known_] = Past{};
  if (!primed_) {
    for (std::size_t i = 0; i < impulses; ++i) past_[i].r.v = r[i].v, past_[i].p.v = p[i].v;
    primed_ = true;
    return false;
  }
  const auto slot = static_cast<std::size_t>(next_);
  next_ = (next_ + 1) % kDepth;
  held_ = std::min(held_ + 1, kDepth);
  const auto depth = static_cast<std::size_t>(held_);  // slots 0 .. depth - 1 are in use
  Row theta{};
  measure(p, r, impulses, slot, theta);
  auto a = products_;
  double trace = 0.0;
  for (std::size_t j = 0; j < depth; ++j) trace += a[j][j];
  if (!(trace > 0.0)) return false;
  for (std::size_t j = 0; j < depth; ++j) a[j][j] += kRidge * a[j][j] + kLeast * trace;
  solve(a, theta, depth);
  for (std::size_t j = depth; j < kDepth; ++j) theta[j] = 0.0;
  for (std::size_t i = 0; i < impulses; ++i) {
    const auto& dp = past_[i].dp;
    p[i].v -= (theta[0] * dp[0].v + theta[1] * dp[1].v) + (theta[2] * dp[2].v + theta[3] * dp[3].v);
  }
  return true;
}

}  // namespace ligature::physics::rod
