#include "firmware/physics/rod/mixing.hpp"

#include <algorithm>

namespace ligature::physics::rod {
namespace {

constexpr double kRidge = 1e-6;  // of the trace; keeps nearly equal residuals from giving huge weights

using Square = std::array<std::array<double, Mixing::kDepth>, Mixing::kDepth>;

// Gaussian elimination of a small symmetric positive definite system, in place; the answer is left in b.
void solve(Square& a, std::array<double, Mixing::kDepth>& b, std::size_t n) noexcept {
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

}  // namespace

void Mixing::reserve(std::size_t impulses) {
  for (auto& past : past_) {
    past.p.resize(impulses);
    past.r.resize(impulses);
  }
}

bool Mixing::step(Vec* p, const Vec* r, std::size_t impulses) noexcept {
  newest_ = (newest_ + 1) % (kDepth + 1);
  Past& now = past_[static_cast<std::size_t>(newest_)];
  std::copy(p, p + impulses, now.p.begin());
  std::copy(r, r + impulses, now.r.begin());
  const auto depth = static_cast<std::size_t>(held_);
  held_ = std::min(held_ + 1, kDepth);
  if (depth == 0) return false;

  const auto before = [&](std::size_t j) -> const Past& {
    return past_[static_cast<std::size_t>((newest_ + kDepth - static_cast<int>(j)) % (kDepth + 1))];
  };
  Square a{};
  std::array<double, kDepth> theta{};
  for (std::size_t i = 0; i < impulses; ++i) {
    std::array<Vec, kDepth> d;
    for (std::size_t j = 0; j < depth; ++j) {
      d[j] = now.r[i] - before(j).r[i];
      theta[j] += dot(d[j], now.r[i]);
      for (std::size_t k = 0; k <= j; ++k) a[j][k] += dot(d[j], d[k]);
    }
  }
  double trace = 0.0;
  for (std::size_t j = 0; j < depth; ++j) trace += a[j][j];
  if (!(trace > 0.0)) return false;
  for (std::size_t j = 0; j < depth; ++j) {
    a[j][j] += kRidge * trace;
    for (std::size_t k = 0; k < j; ++k) a[k][j] = a[j][k];
  }
  solve(a, theta, depth);
  for (std::size_t j = 0; j < depth; ++j) {
    const Past& old = before(j);
    for (std::size_t i = 0; i < impulses; ++i) p[i] -= theta[j] * (now.p[i] - old.p[i]);
  }
  return true;
}

}  // namespace ligature::physics::rod
