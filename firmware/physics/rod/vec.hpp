#pragma once
// Vectors as one register of four doubles: x, y, z, and a spare lane that stays zero. The compiler's vector extension
// makes AVX code from this on x86-64, and pairs of NEON registers on arm64.

#include <cmath>

#include "firmware/physics/members.hpp"
#include "firmware/physics/v3.hpp"

namespace ligature::physics::rod {

using Lanes = Pack;

/// A vector of the world frame; the fourth lane is padding (zero by convention).
struct Vec {
  Lanes v{0.0, 0.0, 0.0, 0.0};
  [[nodiscard]] double operator[](int i) const noexcept { return v[i]; }
  LIGATURE_MEMBERS(Vec, lanes)
};

[[nodiscard]] inline Vec make(double x, double y, double z) noexcept { return {Lanes{x, y, z, 0.0}}; }
[[nodiscard]] inline Vec operator+(Vec a, Vec b) noexcept { return {a.v + b.v}; }
[[nodiscard]] inline Vec operator-(Vec a, Vec b) noexcept { return {a.v - b.v}; }
[[nodiscard]] inline Vec operator-(Vec a) noexcept { return {-a.v}; }
[[nodiscard]] inline Vec operator*(double s, Vec a) noexcept { return {s * a.v}; }
inline Vec& operator+=(Vec& a, Vec b) noexcept { return a = a + b; }
inline Vec& operator-=(Vec& a, Vec b) noexcept { return a = a - b; }

/// a . b; the padding lane is left out.
[[nodiscard]] inline double dot(Vec a, Vec b) noexcept {
  const Lanes p = a.v * b.v;
  return (p[0] + p[1]) + p[2];
}
/// Lane k of the result is the sum of the lanes of the k-th argument.
[[nodiscard]] inline Lanes sums(Lanes p, Lanes q, Lanes r, Lanes s) noexcept {
  const Lanes pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  const Lanes rs = __builtin_shufflevector(r, s, 0, 4, 2, 6) + __builtin_shufflevector(r, s, 1, 5, 3, 7);
  return __builtin_shufflevector(pq, rs, 0, 1, 4, 5) + __builtin_shufflevector(pq, rs, 2, 3, 6, 7);
}
/// |a|^2, |b|^2, |c|^2, |d|^2.
[[nodiscard]] inline Lanes squares(Vec a, Vec b, Vec c, Vec d) noexcept {
  return sums(a.v * a.v, b.v * b.v, c.v * c.v, d.v * d.v);
}
[[nodiscard]] inline double norm(Vec a) noexcept { return std::sqrt(dot(a, a)); }
/// q, shortened to the length `most` if it is longer.
[[nodiscard]] inline Vec limited(Vec q, double most) noexcept {
  const double size2 = dot(q, q);
  return (size2 > most * most ? most / std::sqrt(size2) : 1.0) * q;
}
[[nodiscard]] inline Vec unit(Vec a) noexcept { return (1.0 / norm(a)) * a; }  ///< a / |a|; @pre a is not zero

/// a x b: rotate(a * rotate(b) - rotate(a) * b), rotate = (y, z, x).
[[nodiscard]] inline Vec cross(Vec a, Vec b) noexcept {
  const Lanes c =
      a.v * __builtin_shufflevector(b.v, b.v, 1, 2, 0, 3) - __builtin_shufflevector(a.v, a.v, 1, 2, 0, 3) * b.v;
  return {__builtin_shufflevector(c, c, 1, 2, 0, 3)};
}

/// Four vectors, stored by component. Templates use it to compute four cases at once: their types of vector and number
/// are either Vec and double, or Vecs and Lanes.
using Vecs = V3<Lanes>;
[[nodiscard]] inline Vecs four(Vec a, Vec b, Vec c, Vec d) noexcept {
  const Lanes ab = __builtin_shufflevector(a.v, b.v, 0, 4, 2, 6), cd = __builtin_shufflevector(c.v, d.v, 0, 4, 2, 6);
  const Lanes y0 = __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7), y1 = __builtin_shufflevector(c.v, d.v, 1, 5, 3, 7);
  return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(y0, y1, 0, 1, 4, 5),
          __builtin_shufflevector(ab, cd, 2, 3, 6, 7)};
}

/// 3 x 3 matrix by columns. The columns have three names instead of being an array, because gcc 12 keeps arrays of
/// registers in memory.
struct Mat {
  Vec x, y, z;
  LIGATURE_MEMBERS(Mat, a, b, c)
};

/// Copies `from` to `to` column by column. A plain copy would be slower: gcc 12 compiles it to moves through memory and
/// general registers.
inline void put(Mat& to, const Mat& from) noexcept {
  to.x.v = from.x.v;
  to.y.v = from.y.v;
  to.z.v = from.z.v;
}

/// Component K of a vector in all four lanes.
template <int K>
[[nodiscard]] inline Lanes all(Vec a) noexcept {
  return __builtin_shufflevector(a.v, a.v, K, K, K, K);
}

[[nodiscard]] inline Vec operator*(const Mat& a, Vec x) noexcept {
  return {a.x.v * all<0>(x) + a.y.v * all<1>(x) + a.z.v * all<2>(x)};
}
[[nodiscard]] inline Mat operator*(double s, const Mat& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
[[nodiscard]] inline Mat operator-(const Mat& a, const Mat& b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[nodiscard]] inline Mat operator+(const Mat& a, const Mat& b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[nodiscard]] inline Mat operator*(const Mat& a, const Mat& b) noexcept { return {a * b.x, a * b.y, a * b.z}; }
/// Unit vectors. s * kAxisX is used instead of make(s, 0, 0), because valgrind 3.19 does not support the instruction
/// that make(s, 0, 0) becomes.
inline constexpr Lanes kAxisX = {1, 0, 0, 0}, kAxisY = {0, 1, 0, 0}, kAxisZ = {0, 0, 1, 0};
[[nodiscard]] inline Mat scaled_identity(double s) noexcept { return {{s * kAxisX}, {s * kAxisY}, {s * kAxisZ}}; }

/// alpha u u^T.
[[nodiscard]] inline Mat dyad(Vec u, double alpha) noexcept {
  const Vec w = alpha * u;
  return {{all<0>(u) * w.v}, {all<1>(u) * w.v}, {all<2>(u) * w.v}};
}

[[nodiscard]] inline Mat transposed(const Mat& a) noexcept {
  return {make(a.x[0], a.y[0], a.z[0]), make(a.x[1], a.y[1], a.z[1]), make(a.x[2], a.y[2], a.z[2])};
}

/// a b^T = sum_k a_k b_k^T over columns k.
[[nodiscard]] inline Mat times_transposed(const Mat& a, const Mat& b) noexcept {
  return {{a.x.v * all<0>(b.x) + a.y.v * all<0>(b.y) + a.z.v * all<0>(b.z)},
          {a.x.v * all<1>(b.x) + a.y.v * all<1>(b.y) + a.z.v * all<1>(b.z)},
          {a.x.v * all<2>(b.x) + a.y.v * all<2>(b.y) + a.z.v * all<2>(b.z)}};
}

/// The symmetric matrix with the lower triangle of `a`.
[[nodiscard]] inline Mat mirrored(const Mat& a) noexcept {
  const Lanes c1 = __builtin_shufflevector(a.x.v, a.y.v, 1, 5, 6, 7);  // a10 a11 a21
  const Lanes c2 = __builtin_shufflevector(a.x.v, a.y.v, 2, 6, 4, 7);  // a20 a21 .
  return {a.x, {c1}, {__builtin_shufflevector(c2, a.z.v, 0, 1, 6, 3)}};
}

/// Inverse of a symmetric positive definite matrix, by cofactors; only the lower triangle is read.
[[nodiscard]] inline Mat inverse_spd(const Mat& full) noexcept {
  const Mat a = mirrored(full);
  const Vec r0 = cross(a.y, a.z);
  const Vec r1 = cross(a.z, a.x);
  const Vec r2 = cross(a.x, a.y);
  const double scale = 1.0 / dot(a.x, r0);
  return {scale * r0, scale * r1, scale * r2};
}

}  // namespace ligature::physics::rod
