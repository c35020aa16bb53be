#pragma once
// A SIMD register of four doubles. Force laws and distances are templates over their scalar type: tests use double, the
// loop uses Pack and so computes four nodes or pairs at once. GCC's and Clang's vector types work on any processor, and
// use AVX2 on x86-64-v3.

#include <cmath>

namespace ligature::physics {

using Pack = double __attribute__((vector_size(32)));
using PackMask = decltype(Pack{} < Pack{});
inline constexpr int kLanes = 4;

inline Pack splat(double a) noexcept { return Pack{a, a, a, a}; }

/// Load and store without alignment, because bends start at node 1. They use memcpy: clang ignores a reduced alignment
/// of a vector type's alias, and its aligned load would fault.
inline Pack load(const double* p) noexcept {
  Pack a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
inline void store(double* p, Pack a) noexcept { __builtin_memcpy(p, &a, sizeof a); }

inline double root(double a) noexcept { return std::sqrt(a); }
inline Pack root(Pack a) noexcept {
#if defined(__AVX__) && __has_builtin(__builtin_ia32_sqrtpd256)  // newer versions of clang have it no longer
  return Pack(__builtin_ia32_sqrtpd256(a));
#else
  return Pack{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}

template <class S>
S larger(S a, S b) noexcept {
  return a > b ? a : b;
}
template <class S>
S smaller(S a, S b) noexcept {
  return a < b ? a : b;
}
template <class S>
S magnitude(S a) noexcept {
  return larger(a, -a);
}

/// q limited to [0, 1].
template <class S>
S clamp01(S q) noexcept {
  return larger(smaller(q, S{} + 1.0), S{});
}

inline bool any(bool m) noexcept { return m; }
inline bool any(PackMask m) noexcept { return (m[0] | m[1] | m[2] | m[3]) != 0; }

inline double sum(Pack a) noexcept { return (a[0] + a[1]) + (a[2] + a[3]); }
inline double largest(Pack a) noexcept { return larger(larger(a[0], a[1]), larger(a[2], a[3])); }

}  // namespace ligature::physics
