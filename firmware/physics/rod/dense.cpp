#include "firmware/physics/rod/dense.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/swept.hpp"

namespace ligature::physics::rod {
namespace {

constexpr std::size_t kPanel = 4;

using Four = float __attribute__((vector_size(16)));

/// Inverse of the upper triangle of a panel: what a row has in its four columns, times that, is what to take of each of
/// its rows.
struct Triangle {
  Four row[4];

  Triangle(const float* m, std::size_t stride) noexcept {
    for (int i = 0; i < 4; ++i) {
      row[i] = Four{};
      row[i][i] = 1.0F;
    }
    for (std::size_t j = 0; j < 4; ++j) {  // column by column: X U = I
      for (std::size_t i = 0; i <= j; ++i) {
        float x = i == j ? 1.0F : 0.0F;
        for (std::size_t q = i; q < j; ++q) x -= row[i][static_cast<int>(q)] * m[q * stride + j];
        row[i][static_cast<int>(j)] = x / m[j * stride + j];
      }
    }
  }
  [[nodiscard]] Four of(const float* a) const noexcept {
    return (a[0] * row[0] + a[1] * row[1]) + (a[2] * row[2] + a[3] * row[3]);
  }
};

}  // namespace

void Dense::reserve(std::size_t most) {
  m_.resize((most + 1) * (most + 16));
  x_.resize(most + 16);
}

// Brings the row below with the largest entry of column k up, and clears that column under it.
bool Dense::pivot(std::size_t k) noexcept {
  const std::size_t from = k & ~std::size_t{7};
  std::size_t best = k;
  for (std::size_t i = k + 1; i < n_; ++i) {
    if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
  }
  float* const top = row(k);
  if (best != k) std::swap_ranges(top + from, top + stride_, row(best) + from);
  if (!(std::abs(top[k]) > 0.0F)) return false;
  for (std::size_t i = k + 1; i < n_; ++i) {
    float* const a = row(i);
    const Eight f = all_eight(a[k] / top[k]);
    for (std::size_t j = from; j < stride_; j += 8) store_eight(a + j, load_eight(a + j) - f * load_eight(top + j));
  }
  return true;
}

// Four pivots from row k on, cleared among themselves. @return false when one has shrunk, and nothing is lost.
bool Dense::panel(std::size_t k) noexcept {
  constexpr float kShrunk = 1e-4F;
  const std::size_t from = k & ~std::size_t{7};
  for (std::size_t i = k; i < k + kPanel; ++i) {
    float* const a = row(i);
    const float least = kShrunk * std::abs(a[i]);
    for (std::size_t p = k; p < i; ++p) {
      const float* const top = row(p);
      const Eight factor = all_eight(a[p] / top[p]);
      for (std::size_t j = from; j < stride_; j += 8)
        store_eight(a + j, load_eight(a + j) - factor * load_eight(top + j));
    }
    if (!(std::abs(a[i]) > least)) return false;
  }
  return true;
}

// Takes the panel from all rows under it, two rows and eight columns at a time. What lies left of it is not read again.
void Dense::clear_below(std::size_t k) noexcept {
  const std::size_t stride = stride_, from = (k + kPanel) & ~std::size_t{7};
  const float* const t = row(k);
  const Triangle triangle(t + k, stride);
  std::size_t i = k + kPanel;
  for (; i + 1 < n_; i += 2) {
    float *const a = row(i), *const b = a + stride;
    const Four f = triangle.of(a + k), g = triangle.of(b + k);
    const Eight f0 = all_eight(f[0]), f1 = all_eight(f[1]), f2 = all_eight(f[2]), f3 = all_eight(f[3]);
    const Eight g0 = all_eight(g[0]), g1 = all_eight(g[1]), g2 = all_eight(g[2]), g3 = all_eight(g[3]);
    for (std::size_t j = from; j < stride; j += 8) {
      const Eight t0 = load_eight(t + j), t1 = load_eight(t + stride + j), t2 = load_eight(t + 2 * stride + j),
                  t3 = load_eight(t + 3 * stride + j);
      store_eight(a + j, (((load_eight(a + j) - f0 * t0) - f1 * t1) - f2 * t2) - f3 * t3);
      store_eight(b + j, (((load_eight(b + j) - g0 * t0) - g1 * t1) - g2 * t2) - g3 * t3);
    }
  }
  if (i == n_) return;
  float* const a = row(i);
  const Four f = triangle.of(a + k);
  for (std::size_t p = 0; p < kPanel; ++p) {
    const Eight factor = all_eight(f[static_cast<int>(p)]);
    for (std::size_t j = from; j < stride; j += 8)
      store_eight(a + j, load_eight(a + j) - factor * load_eight(t + p * stride + j));
  }
}

void Dense::substitute() noexcept {
  std::fill(x_.begin(), x_.end(), 0.0F);
  for (std::size_t k = n_; k-- > 0;) {
    const float* const a = row(k);
    Eight sum{};
    for (std::size_t j = (k + 1) & ~std::size_t{7}; j < n_; j += 8)
      sum += load_eight(a + j) * load_eight(x_.data() + j);
    // x_ is zero up to k, so what elimination left there does not count.
    const float known = ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
    x_[k] = (a[n_] - known) / a[k];
  }
}

bool Dense::solve() noexcept {
  for (std::size_t k = 0; k < n_;) {
    if (k + kPanel <= n_ && panel(k)) {
      clear_below(k);
      k += kPanel;
    } else if (!pivot(k++)) {
      return false;
    }
  }
  substitute();
  return true;
}

}  // namespace ligature::physics::rod
