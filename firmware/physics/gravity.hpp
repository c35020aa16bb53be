#pragma once

#include "firmware/physics/vec.hpp"

namespace ligature::physics {

/// Gravity, paper III.A.1: f_g = G m as a vector, N. The paper writes it as a scalar; direction and size are the
/// scene's.
template <class S>
V3<S> gravity_N(S mass_kg, const V3<S>& g_m_per_s2) noexcept {
  return mass_kg * g_m_per_s2;
}

}  // namespace ligature::physics
