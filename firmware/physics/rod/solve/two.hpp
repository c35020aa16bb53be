#pragma once
// Two doubles in one register, for the same arithmetic on two chains of nodes at once, without shuffles.

#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

/// One number for each of the two chains of nodes that band_solver.hpp eliminates towards its two middle (core) nodes.
/// Lane 0: the left chain; lane 1: the right one.
using Two = double __attribute__((vector_size(16)));

/// Two vectors, one in each lane.
using Twos = V3<Two>;

[[nodiscard]] inline Twos both(const Vec& left, const Vec& right) noexcept {
  return {Two{left.v[0], right.v[0]}, Two{left.v[1], right.v[1]}, Two{left.v[2], right.v[2]}};
}
template <int Lane>
[[nodiscard]] inline Vec lane(const Twos& a) noexcept {
  // The zeros come last in the shuffle. Otherwise the compiler emits a `vmovq` of two registers, which valgrind does
  // not support
  const Two xy = __builtin_shufflevector(a.x, a.y, Lane, 2 + Lane), zz = __builtin_shufflevector(a.z, a.z, Lane, Lane);
  const Lanes xyzz = __builtin_shufflevector(xy, zz, 0, 1, 2, 3);
  return {__builtin_shufflevector(xyzz, Lanes{}, 0, 1, 2, 7)};
}
[[nodiscard]] inline Twos swapped(const Twos& a) noexcept {
  return {__builtin_shufflevector(a.x, a.x, 1, 0), __builtin_shufflevector(a.y, a.y, 1, 0),
          __builtin_shufflevector(a.z, a.z, 1, 0)};
}

/// A 3 x 3 matrix in each lane, by columns.
struct TwoMats {
  Twos x, y, z;
};

/// less() is r - A b, less_transposed() is r - A^T b. The order of summation keeps the latency of each at three
/// multiply-adds.
[[nodiscard]] inline Twos less(const Twos& r, const TwoMats& a, const Twos& b) noexcept {
  return {r.x - a.x.x * b.x - a.y.x * b.y - a.z.x * b.z, r.y - a.x.y * b.x - a.y.y * b.y - a.z.y * b.z,
          r.z - a.x.z * b.x - a.y.z * b.y - a.z.z * b.z};
}
[[nodiscard]] inline Twos less_transposed(const Twos& r, const TwoMats& a, const Twos& b) noexcept {
  return {r.x - a.x.x * b.x - a.x.y * b.y - a.x.z * b.z, r.y - a.y.x * b.x - a.y.y * b.y - a.y.z * b.z,
          r.z - a.z.x * b.x - a.z.y * b.y - a.z.z * b.z};
}
[[nodiscard]] inline TwoMats operator*(Two s, const TwoMats& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
template <int Lane>
[[nodiscard]] inline Mat lane(const TwoMats& a) noexcept {
  return {lane<Lane>(a.x), lane<Lane>(a.y), lane<Lane>(a.z)};
}

/// A symmetric 3 x 3 matrix in each lane: its lower triangle.
struct TwoSyms {
  Two xx, xy, xz, yy, yz, zz;
};

[[nodiscard]] inline TwoSyms operator-(const TwoSyms& a, const TwoSyms& b) noexcept {
  return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz};
}
[[nodiscard]] inline TwoSyms operator*(Two s, const TwoSyms& a) noexcept {
  return {s * a.xx, s * a.xy, s * a.xz, s * a.yy, s * a.yz, s * a.zz};
}
[[nodiscard]] inline Twos operator*(const TwoSyms& a, const Twos& b) noexcept {
  return {a.xx * b.x + a.xy * b.y + a.xz * b.z, a.xy * b.x + a.yy * b.y + a.yz * b.z,
          a.xz * b.x + a.yz * b.y + a.zz * b.z};
}
/// Two symmetric matrices, one for each lane; only their lower triangles are read.
[[nodiscard]] inline TwoSyms both(const Mat& left, const Mat& right) noexcept {
  const Twos x = both(left.x, right.x), y = both(left.y, right.y), z = both(left.z, right.z);
  return {x.x, x.y, x.z, y.y, y.z, z.z};
}
[[nodiscard]] inline TwoSyms swapped(const TwoSyms& a) noexcept {
  const Twos p = swapped(Twos{a.xx, a.xy, a.xz}), q = swapped(Twos{a.yy, a.yz, a.zz});
  return {p.x, p.y, p.z, q.x, q.y, q.z};
}
template <int Lane>
[[nodiscard]] inline Mat lane(const TwoSyms& a) noexcept {
  return {lane<Lane>(Twos{a.xx, a.xy, a.xz}), lane<Lane>(Twos{a.xy, a.yy, a.yz}), lane<Lane>(Twos{a.xz, a.yz, a.zz})};
}

/// adj(a) = det(a) a^-1.
[[nodiscard]] inline TwoSyms adjugate(const TwoSyms& a) noexcept {
  return {a.yy * a.zz - a.yz * a.yz, a.xz * a.yz - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy,
          a.xx * a.zz - a.xz * a.xz, a.xy * a.xz - a.xx * a.yz, a.xx * a.yy - a.xy * a.xy};
}

}  // namespace ligature::physics::rod
