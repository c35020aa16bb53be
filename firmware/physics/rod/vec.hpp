#pragma once
// Four doubles as one register: x, y, z and a spare lane that stays zero. The compiler's vector extension, so the same
// source becomes AVX on x86-64 and NEON pairs on arm64.

#include <cmath>

namespace ligature::physics::rod {

using Lanes = double __attribute__((vector_size(32)));
using LaneIndex = long long __attribute__((vector_size(32)));

/// A vector of the world frame; the fourth lane is padding (zero by convention).
struct Vec {
  Lanes v{0.0, 0.0, 0.0, 0.0};
  [[nodiscard]] double operator[](int i) const noexcept { return v[i]; }
};

[[nodiscard]] inline Vec make(double x, double y, double z) noexcept { return {Lanes{x, y, z, 0.0}}; }
[[nodiscard]] inline Vec splat(double a) noexcept { return {Lanes{a, a, a, a}}; }
[[nodiscard]] inline Vec operator+(Vec a, Vec b) noexcept { return {a.v + b.v}; }
[[nodiscard]] inline Vec operator-(Vec a, Vec b) noexcept { return {a.v - b.v}; }
[[nodiscard]] inline Vec operator-(Vec a) noexcept { return {-a.v}; }
[[nodiscard]] inline Vec operator*(double s, Vec a) noexcept { return {s * a.v}; }
[[nodiscard]] inline Vec operator*(Vec a, double s) noexcept { return {s * a.v}; }
inline Vec& operator+=(Vec& a, Vec b) noexcept { return a = a + b; }
inline Vec& operator-=(Vec& a, Vec b) noexcept { return a = a - b; }

/// a . b over all four lanes (padding is zero).
[[nodiscard]] inline double dot(Vec a, Vec b) noexcept {
  const Lanes p = a.v * b.v;
  return (p[0] + p[1]) + p[2];
}
[[nodiscard]] inline double norm(Vec a) noexcept { return std::sqrt(dot(a, a)); }

/// a x b: rotate(a * rotate(b) - rotate(a) * b), rotate = (y, z, x).
[[nodiscard]] inline Vec cross(Vec a, Vec b) noexcept {
  constexpr LaneIndex kYzx = {1, 2, 0, 3};
  const Lanes c = a.v * __builtin_shuffle(b.v, kYzx) - __builtin_shuffle(a.v, kYzx) * b.v;
  return {__builtin_shuffle(c, kYzx)};
}

/// 3 x 3 matrix by columns.
struct Mat {
  Vec c[3];
};

[[nodiscard]] inline Vec operator*(const Mat& a, Vec x) noexcept {
  return {a.c[0].v * x[0] + a.c[1].v * x[1] + a.c[2].v * x[2]};
}
[[nodiscard]] inline Mat operator*(double s, const Mat& a) noexcept { return {{s * a.c[0], s * a.c[1], s * a.c[2]}}; }
[[nodiscard]] inline Mat operator-(const Mat& a, const Mat& b) noexcept {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}
[[nodiscard]] inline Mat operator+(const Mat& a, const Mat& b) noexcept {
  return {{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]}};
}
[[nodiscard]] inline Mat operator*(const Mat& a, const Mat& b) noexcept {
  return {{a * b.c[0], a * b.c[1], a * b.c[2]}};
}
/// Unit vectors; s * kAxis[k] keeps a scalar in one register (valgrind 3.19 cannot read the move that make(s, 0, 0)
/// becomes).
inline constexpr Lanes kAxisX = {1, 0, 0, 0}, kAxisY = {0, 1, 0, 0}, kAxisZ = {0, 0, 1, 0};
[[nodiscard]] inline Mat scaled_identity(double s) noexcept { return {{{s * kAxisX}, {s * kAxisY}, {s * kAxisZ}}}; }

/// alpha u u^T + beta I.
[[nodiscard]] inline Mat dyad(Vec u, double alpha, double beta) noexcept {
  const Vec w = alpha * u;
  return {{{u[0] * w.v + beta * kAxisX}, {u[1] * w.v + beta * kAxisY}, {u[2] * w.v + beta * kAxisZ}}};
}

[[nodiscard]] inline Mat transposed(const Mat& a) noexcept {
  return {{make(a.c[0][0], a.c[1][0], a.c[2][0]), make(a.c[0][1], a.c[1][1], a.c[2][1]),
           make(a.c[0][2], a.c[1][2], a.c[2][2])}};
}

/// a b^T = sum_k a_k b_k^T over columns k.
[[nodiscard]] inline Mat times_transposed(const Mat& a, const Mat& b) noexcept {
  Mat r;
  for (int j = 0; j < 3; ++j) r.c[j] = {a.c[0].v * b.c[0][j] + a.c[1].v * b.c[1][j] + a.c[2].v * b.c[2][j]};
  return r;
}

/// The symmetric matrix with the lower triangle of `a`.
[[nodiscard]] inline Mat mirrored(const Mat& a) noexcept {
  constexpr LaneIndex kSecond = {1, 5, 6, 7}, kThird = {2, 6, 4, 7};
  const Lanes c1 = __builtin_shuffle(a.c[0].v, a.c[1].v, kSecond);  // a10 a11 a21
  const Lanes c2 = __builtin_shuffle(a.c[0].v, a.c[1].v, kThird);   // a20 a21 .
  constexpr LaneIndex kDiagonal = {0, 1, 6, 3};
  return {{a.c[0], {c1}, {__builtin_shuffle(c2, a.c[2].v, kDiagonal)}}};
}

/// Inverse of a symmetric positive definite matrix, by cofactors; only the lower triangle is read.
[[nodiscard]] inline Mat inverse_spd(const Mat& full) noexcept {
  const Mat a = mirrored(full);
  const Vec r0 = cross(a.c[1], a.c[2]);
  const Vec r1 = cross(a.c[2], a.c[0]);
  const Vec r2 = cross(a.c[0], a.c[1]);
  const double scale = 1.0 / dot(a.c[0], r0);
  return {{scale * r0, scale * r1, scale * r2}};
}

}  // namespace ligature::physics::rod
