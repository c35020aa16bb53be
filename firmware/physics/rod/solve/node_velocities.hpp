#pragma once
// Velocities of the nodes on which contacts act, for the sweeps: in single precision, eight nodes per register.

#include <cstdint>
#include <cstring>

#include "firmware/physics/rod/solve/floats.hpp"
#include "firmware/physics/rod/vec.hpp"

namespace ligature::physics::rod {

using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32)));

template <class Register>
[[nodiscard]] inline Register load_as(const float* at) noexcept {
  Register out;
  std::memcpy(&out, at, sizeof out);
  return out;
}
template <class Register>
inline void store_as(float* at, Register value) noexcept {
  std::memcpy(at, &value, sizeof value);
}
[[nodiscard]] inline Eight all_eight(float a) noexcept { return Eight{a, a, a, a, a, a, a, a}; }

/// Node velocities in blocks of eight nodes: eight x, eight y, eight z. A sweep only approximates the solution with the
/// full matrix, so rounding to 1e-7 of a velocity is far below the error of a pass. Impulses stay in double precision.
class SweptVelocities {
 public:
  void reserve(int nodes) { xyz_.resize(3 * (static_cast<std::size_t>(nodes) + 16)); }

  /// Number of nodes rounded up to whole blocks, the length of a padded column.
  [[nodiscard]] static std::size_t padded(int nodes) noexcept {
    return (static_cast<std::size_t>(nodes) + 7) & ~std::size_t{7};
  }
  /// Index of a node's x component; its y and z are 8 and 16 places later. Nodes are counted from the first one loaded.
  [[nodiscard]] static std::int32_t place(int node) noexcept { return (node >> 3) * 24 + (node & 7); }

  void load(const Vec* v, int nodes) noexcept {
    for (int j = 0; j < nodes; ++j) {
      float* at = xyz_.data() + place(j);
      at[0] = static_cast<float>(v[j][0]);
      at[8] = static_cast<float>(v[j][1]);
      at[16] = static_cast<float>(v[j][2]);
    }
  }

  /// Weighted sum of `count` nodes' velocities: sum_k w_k v[place_k].
  [[nodiscard]] Vec mix(const std::int32_t* places, const float* w, int count) const noexcept {
    float x = 0.0F, y = 0.0F, z = 0.0F;
    for (int k = 0; k < count; ++k) {
      const float* at = xyz_.data() + places[k];
      x += w[k] * at[0];
      y += w[k] * at[8];
      z += w[k] * at[16];
    }
    return make(x, y, z);
  }

  /// Adds the velocity changes by an impulse p: v_j += column_j p for every node j. @param nodes their number, rounded
  /// up by padded().
  void push(const float* column, std::size_t nodes, Vec p) noexcept {
    const Eight px = all_eight(static_cast<float>(p[0])), py = all_eight(static_cast<float>(p[1])),
                pz = all_eight(static_cast<float>(p[2]));
    float* at = xyz_.data();
    for (std::size_t j = 0; j < nodes; j += 8, at += 24) {
      const Eight c = load_as<Eight>(column + j);
      store_as(at, load_as<Eight>(at) + c * px);
      store_as(at + 8, load_as<Eight>(at + 8) + c * py);
      store_as(at + 16, load_as<Eight>(at + 16) + c * pz);
    }
  }

 private:
  Floats xyz_;
};

}  // namespace ligature::physics::rod
