#pragma once
// Vectors of three components over any scalar type: double for one vector, Pack for four at once.

#include "firmware/physics/members.hpp"
#include "firmware/physics/pack.hpp"

namespace ligature::physics {

template <class S>
struct V3 {
  S x, y, z;
  LIGATURE_MEMBERS(V3, a, b, c)
};

template <class S>
V3<S> operator+(const V3<S>& a, const V3<S>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class S>
V3<S> operator-(const V3<S>& a, const V3<S>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class S>
V3<S> operator-(const V3<S>& a) noexcept {
  return {-a.x, -a.y, -a.z};
}
template <class S>
V3<S> operator*(const S& k, const V3<S>& a) noexcept {
  return {k * a.x, k * a.y, k * a.z};
}
template <class S>
S dot(const V3<S>& a, const V3<S>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
V3<S> cross(const V3<S>& a, const V3<S>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class S>
S norm(const V3<S>& a) noexcept {
  return root(dot(a, a));
}

}  // namespace ligature::physics
