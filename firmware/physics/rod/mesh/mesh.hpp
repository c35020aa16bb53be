#pragma once
// The mesh of a rod: material coordinates (length along the unstretched thread) and masses of its nodes, and the
// constant bending matrix.

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/model/material.hpp"

namespace ligature::physics::rod {

/// Is the tangent at a node free or imposed?
enum class Clamp : std::uint8_t { kFree, kClamped };

/// Rest lengths l_j, node masses m_i = rho (l_{i-1} + l_i) / 2 (rho: mass per length), and the pentadiagonal matrix K_b
/// of the bending energy
///   E_b = sum_i w_i / 2 |t_i - t_{i-1}|^2,  w_i = 2 EI / (l_{i-1} + l_i),  t_j = (x_{j+1} - x_j) / l_j
/// x_j: positions of the nodes, EI: bending stiffness. E_b is quadratic in the positions, also for unequal segments. So
/// the force is linear in them, with the same constant matrix for x, y and z. A clamped end adds a half vertex of
/// weight 2 EI / l, with the clamp's direction as the missing tangent. The error is second order in l for smooth
/// shapes. In a fold the energy is limited to 2 EI / l, so a knot needs l <= diameter.
struct Mesh {
  std::vector<double> s;         ///< n material coordinates, m, from 0 to the length
  std::vector<double> rest;      ///< n - 1 rest lengths (sized n; the last is 0)
  std::vector<double> inv_rest;  ///< 1 / rest
  std::vector<double> mass;      ///< n lumped masses, kg
  std::vector<double> weight;    ///< w_i of vertex i; 0 at free ends
  /// Bending stiffness of the halves of the segments before and after node i, N m^2: harmonic mean over the half
  std::vector<double> EI_before, EI_after;
  std::vector<double> kd, ke, kb;  ///< K_b(i, i), (i, i+1), (i, i+2)
  std::vector<Clamp> clamp;        ///< of node i; a clamped inner node has half vertices on both sides

  [[nodiscard]] int nodes() const noexcept { return static_cast<int>(s.size()); }
  void resize(int n);

  /// Computes all other members from `s` and `clamp`. O(n), no allocation.
  void rebuild(const Material& material) noexcept;
  LIGATURE_MEMBERS(Mesh, s, rest, inv_rest, mass, weight, EI_before, EI_after, kd, ke, kb, clamp)
};

}  // namespace ligature::physics::rod
