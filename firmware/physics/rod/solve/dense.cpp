#include "firmware/physics/rod/solve/dense.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/solve/node_velocities.hpp"

namespace ligature::physics::rod {
namespace {

constexpr std::size_t kPanel = 4;

// Sets a = scale (a - sum over q of factors[q] x row q of `top`). The factors may be entries of `a` itself.
template <std::size_t Rows>
inline void take_away(float* a, const float* factors, const float* top, std::size_t from, std::size_t stride,
                      float scale = 1.0F) noexcept {
  Eight f[std::max<std::size_t>(Rows, 1)];
  for (std::size_t q = 0; q < Rows; ++q) f[q] = all_eight(factors[q]);
  for (std::size_t j = from; j < stride; j += 8) {
    Eight sum = load_as<Eight>(a + j);
    for (std::size_t q = 0; q < Rows && q < kPanel; ++q) sum -= f[q] * load_as<Eight>(top + q * stride + j);
    if constexpr (Rows > kPanel) {  // two independent sums, for latency
      Eight more = f[kPanel] * load_as<Eight>(top + kPanel * stride + j);
      for (std::size_t q = kPanel + 1; q < Rows; ++q) more += f[q] * load_as<Eight>(top + q * stride + j);
      sum -= more;
    } else {
      sum *= scale;
    }
    store_as(a + j, sum);
  }
}

}  // namespace

void Dense::reserve(std::size_t most) {
  m_.resize((most + 1) * (most + 16));
  x_.resize(most + 16);
  first_.resize(most + 16);
  panels_.reserve(most);
}

// Partial pivoting for column k: exchanges rows, scales the pivot to 1, and eliminates the column below the pivot.
bool Dense::pivot(std::size_t k) noexcept {
  const std::size_t from = k & ~std::size_t{7};
  std::size_t best = k;
  for (std::size_t i = k + 1; i < n_; ++i) {
    if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
  }
  float* const top = row(k);
  if (best != k) std::swap_ranges(top + from, top + stride_, row(best) + from);
  if (!(std::abs(top[k]) > 0.0F)) return false;
  take_away<0>(top, nullptr, nullptr, from, stride_, 1.0F / top[k]);
  clear_below(k, 1, k + 1);
  return true;
}

// Adds row i = k + Before to the panel that begins at row k: eliminates the panel's pivots from row i, scales its own
// pivot to 1, and eliminates column i from the panel's other rows. @return false if the pivot has shrunk; then nothing
// is changed.
template <std::size_t Before>
bool Dense::join(std::size_t k) noexcept {
  // A pivot counts as shrunk if it is below kShrunk times its value before this panel, or below kNoise times its
  // initial value.
  constexpr float kShrunk = 1e-4F, kNoise = 1e-6F;
  const std::size_t i = k + Before, from = k & ~std::size_t{7};
  float *const a = row(i), *const top = row(k);
  float left = a[i];
  for (std::size_t p = 0; p < Before; ++p) left -= a[k + p] * top[p * stride_ + i];
  if (!(std::abs(left) > std::max(kShrunk * std::abs(a[i]), kNoise * first_.data()[i]) && first_.data()[i] > 0.0F))
    return false;
  take_away<Before>(a, a + k, top, from, stride_, 1.0F / left);
  for (std::size_t p = 0; p < Before; ++p) take_away<1>(top + p * stride_, top + p * stride_ + i, a, from, stride_);
  return true;
}

// Reduces up to four rows and columns from k on to a unit matrix. @return how many; fewer than four if a pivot is too
// small.
std::size_t Dense::panel(std::size_t k) noexcept {
  const std::size_t rows = std::min(kPanel, n_ - k);
  if (!join<0>(k)) return 0;
  if (rows < 2 || !join<1>(k)) return 1;
  if (rows < 3 || !join<2>(k)) return 2;
  return rows < 4 || !join<3>(k) ? 3 : 4;
}

// Eliminates columns k to k + pivots - 1 from all rows >= first. In these columns, rows k to k + pivots - 1 must be a
// unit matrix. The eliminated entries of the other rows are not set to zero, because they are not read again.
void Dense::clear_below(std::size_t k, std::size_t pivots, std::size_t first) noexcept {
  const std::size_t from = (k + pivots) & ~std::size_t{7};
  const float* const top = row(k);
  for (std::size_t i = first; i < n_; ++i) {
    float* const a = row(i);
    if (pivots == 2 * kPanel) {
      take_away<2 * kPanel>(a, a + k, top, from, stride_);
    } else if (pivots == kPanel) {
      take_away<kPanel>(a, a + k, top, from, stride_);
    } else {
      for (std::size_t p = 0; p < pivots; ++p) take_away<1>(a, a + k + p, top + p * stride_, from, stride_);
    }
  }
}

// Eliminates the eight columns from k on, as two panels of four. The first panel has been factorised before the call.
// @return the number of columns done; fewer than eight if a pivot of the second panel is too small.
std::size_t Dense::two_panels(std::size_t k) noexcept {
  const std::size_t l = k + kPanel, end = l + kPanel;
  for (std::size_t i = l; i < end; ++i) take_away<kPanel>(row(i), row(i) + k, row(k), l & ~std::size_t{7}, stride_);
  const std::size_t pivots = panel(l);
  if (pivots < kPanel) {
    clear_below(k, kPanel, end);
    clear_below(l, pivots, l + pivots);
    return kPanel + pivots;
  }
  for (std::size_t i = k; i < l; ++i) take_away<kPanel>(row(i), row(i) + l, row(l), l & ~std::size_t{7}, stride_);
  clear_below(k, 2 * kPanel, end);
  return 2 * kPanel;
}

// Back substitution, panel by panel from the last. Elimination has left a unit matrix in each panel's own rows and
// columns, so the unknowns of one panel do not depend on each other.
void Dense::substitute() noexcept {
  x_.clear();
  float* const x = x_.data();
  for (std::size_t end = n_; end > 0;) {
    const std::size_t k = panels_.back();
    panels_.pop_back();
    const float* rows[2 * kPanel];  // for a smaller panel some sums are not used
    for (std::size_t i = 0; i < 2 * kPanel; ++i) rows[i] = row(std::min(k + i, n_ - 1));
    Eight sum[2 * kPanel] = {};
    for (std::size_t j = end & ~std::size_t{7}; j < n_; j += 8) {
      const Eight at = load_as<Eight>(x + j);
      for (std::size_t i = 0; i < 2 * kPanel; ++i) sum[i] += load_as<Eight>(rows[i] + j) * at;
    }
    // The sums run over whole groups of eight columns, so also over columns before `end`. Their unknowns x are still
    // zero and add nothing.
    for (std::size_t i = 0; k + i < end; ++i) {
      const Eight s = sum[i];
      x[k + i] = rows[i][n_] - (((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7])));
    }
    end = k;
  }
}

bool Dense::solve(TickTime& time) noexcept {
  Pieces pieces(time);
  const long panel_price = static_cast<long>(n_ * n_) * 2 / 3;
  for (std::size_t i = 0; i < n_; ++i) first_.data()[i] = std::abs(row(i)[i]);
  panels_.clear();
  for (std::size_t k = 0; k < n_;) {
    if (!pieces.allow(panel_price)) return false;
    panels_.push_back(k);
    const std::size_t pivots = panel(k);
    if (pivots == kPanel && k + 2 * kPanel <= n_) {
      const std::size_t cleared = two_panels(k);
      if (cleared > kPanel && cleared < 2 * kPanel) panels_.push_back(k + kPanel);
      k += cleared;
      continue;
    }
    clear_below(k, pivots, k + pivots);
    k += pivots;
    if (pivots == 0) panels_.pop_back();
    if (pivots < kPanel && k < n_) {
      panels_.push_back(k);
      if (!pivot(k++)) return false;
    }
  }
  substitute();
  return true;
}

}  // namespace ligature::physics::rod
