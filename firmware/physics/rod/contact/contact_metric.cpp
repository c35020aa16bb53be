#include "firmware/physics/rod/contact/contact_metric.hpp"

#include <algorithm>
#include <cassert>

namespace ligature::physics::rod {

void ContactMetric::reserve(int nodes, int window) {
  capacity_ = std::min(nodes, window);
  const auto w = static_cast<std::size_t>(capacity_) + 4;
  table_.assign(w * w, 0.0);
  row_.assign(w * w + 16, 0.0F);
  for (auto* array : {&d_, &l1_, &l2_}) array->assign(static_cast<std::size_t>(nodes) + 2, 0.0);
}

bool ContactMetric::prepare(const Mesh& mesh, const Material& material, double dt_s, int first, int last,
                            TickTime& time) noexcept {
  assert(0 <= first && first < last && last < mesh.nodes() && last - first < capacity_);
  first_ = first;
  last_ = last;
  factor(mesh, material, dt_s);
  if (invert(time)) return true;
  invalidate();
  return false;
}

// Factorises C (contact_metric.hpp) for the window of nodes first_ to last_, where the contacts are. invert() needs the
// rows of C^-1 for these nodes only. They are the inverse of the matrix that remains when all other nodes are
// eliminated from C. (The inverse of C's own rows and columns of the window would be wrong: it would hold the other
// nodes fixed.) Two steps eliminate them:
// 1. From the thread's end down to last_ + 1. C couples a node only to the two nodes on each side of it, so this
//    changes only entries of last_ and last_ - 1: on_last is subtracted from (last_, last_), on_before from
//    (last_ - 1, last_ - 1), and on_pair from (last_ - 1, last_).
// 2. From the thread's start up to last_, as L D L^T. L has a unit diagonal, and l1_ and l2_ are its two subdiagonals;
//    D is the diagonal d_. The entries of d_, l1_ and l2_ inside the window are then the factors of the remaining
//    matrix.
void ContactMetric::factor(const Mesh& mesh, const Material& material, double dt_s) noexcept {
  const auto n = static_cast<std::size_t>(mesh.nodes()), z = static_cast<std::size_t>(last_);
  const double bend = dt_s * (dt_s + material.bend_tau_s), inertia = 1.0 + material.drag_per_s * dt_s;
  const auto diag = [&](std::size_t i) { return mesh.mass[i] * inertia + bend * mesh.kd[i]; };
  // Step 1. It needs only the values of the two nodes eliminated last
  double d1 = 0.0, d2 = 0.0, f1 = 0.0;  // pivots of i+1 and i+2; elimination factor of i+1
  double on_last = 0.0, on_before = 0.0, on_pair = 0.0;
  for (std::size_t i = n; i-- > z;) {
    const double skip = i + 2 < n ? bend * mesh.kb[i] : 0.0;
    const double f = i + 1 < n ? bend * mesh.ke[i] - (i + 2 < n ? skip * f1 : 0.0) : 0.0;
    const double g = i + 1 < n ? f / d1 : 0.0;
    const double less = g * f + (i + 2 < n ? skip * skip / d2 : 0.0);
    if (i == z) {
      on_last = less;
      if (z + 1 < n && z > 0) {
        const double b = bend * mesh.kb[z - 1];
        on_before = b * b / d1;
        on_pair = b * g;
      }
      break;
    }
    d2 = d1;
    d1 = diag(i) - less;
    f1 = g;
  }
  // Step 2
  for (std::size_t i = 0; i <= z; ++i) {
    const double skip = i > 1 ? bend * mesh.kb[i - 2] : 0.0;
    double f = i > 0 ? bend * mesh.ke[i - 1] : 0.0;
    if (i == z && i > 0) f -= on_pair;
    if (i > 1) f -= skip * l1_[i - 1];
    l1_[i] = i > 0 ? f / d_[i - 1] : 0.0;
    l2_[i] = i > 1 ? skip / d_[i - 2] : 0.0;
    d_[i] = diag(i) - l1_[i] * f - l2_[i] * skip;
    if (i + 1 == z) d_[i] -= on_before;
    if (i == z) d_[i] -= on_last;
  }
}

// Computes the rows of C^-1 for the window: row operations turn the identity matrix into L^-1 (first loop), and this
// into L^-T D^-1 L^-1 (second loop).
bool ContactMetric::invert(TickTime& time) noexcept {
  const auto a = static_cast<std::size_t>(first_), w = static_cast<std::size_t>(last_) - a + 1;
  stride_ = (w + 3) & ~std::size_t{3};
  const auto row_at = [&](std::size_t i) { return table_.data() + i * stride_; };
  Pieces pieces(time);
  for (std::size_t i = 0; i < w; ++i) {
    if (!pieces.allow(static_cast<long>(w))) return false;
    double* r = row_at(i);
    std::fill(r, r + stride_, 0.0);
    r[i] = 1.0;
    if (i > 0) {
      const double* p = row_at(i - 1);
      const double g = l1_[a + i];
      for (std::size_t j = 0; j < i; ++j) r[j] -= g * p[j];
    }
    if (i > 1) {
      const double* p = row_at(i - 2);
      const double g = l2_[a + i];
      for (std::size_t j = 0; j + 1 < i; ++j) r[j] -= g * p[j];
    }
  }
  std::fill(row_at(w), row_at(w + 2), 0.0);  // two zero rows, so that the last rows need no special case
  for (std::size_t i = w; i-- > 0;) {
    if (!pieces.allow(4 * static_cast<long>(w))) return false;
    double* const __restrict r = row_at(i);
    const double inv = 1.0 / d_[a + i];
    const double* const __restrict p = row_at(i + 1), * const __restrict q = row_at(i + 2);
    const double g = i + 1 < w ? l1_[a + i + 1] : 0.0, h = i + 2 < w ? l2_[a + i + 2] : 0.0;
    float* const __restrict out = row_.data() + i * stride_;
    for (std::size_t j = 0; j < stride_; ++j) {
      r[j] = inv * r[j] - g * p[j] - h * q[j];
      out[j] = static_cast<float>(r[j]);
    }
  }
  return true;
}

}  // namespace ligature::physics::rod
