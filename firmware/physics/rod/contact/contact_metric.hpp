#pragma once
// The simplified constant matrix C with which contact sweeps are computed.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/mesh/mesh.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

/// The simplified matrix of the sweeps,
///   C = M (1 + c dt) + dt (dt + tau_b) K_b
/// M: masses, c: air drag, tau_b: damping time, K_b: bending matrix. It is the matrix A of a substep (assembly.hpp)
/// without the terms of stretch, geometry and holds: a scalar pentadiagonal matrix times the 3 x 3 identity, constant
/// while mesh and dt are. Because A >= C, J A^-1 J^T <= J C^-1 J^T (J: rows of all contacts). So an impulse step
/// computed with C never overshoots (a majorise-minimise argument for the frictionless problem). With C, a contact has
/// the same effective mass in all directions.
class ContactMetric {
 public:
  void reserve(int nodes, int window);

  /// Computes C^-1 on the w nodes from first to last. O(n + w^2), no allocation. @pre last - first < capacity.
  /// @return false if the time was over first; then the table is invalid.
  [[nodiscard]] bool prepare(const Mesh& mesh, const Material& material, double dt_s, int first, int last,
                             TickTime& time) noexcept;

  [[nodiscard]] bool covers(int first, int last) const noexcept { return first_ <= first && last <= last_; }
  void invalidate() noexcept { first_ = 1, last_ = 0; }
  [[nodiscard]] int first() const noexcept { return first_; }
  [[nodiscard]] int capacity() const noexcept { return capacity_; }

  /// A node's row of C^-1, in single precision; entry j belongs to node first() + j. Up to seven entries past its end
  /// may be read.
  [[nodiscard]] const float* row(int node) const noexcept {
    return row_.data() + static_cast<std::size_t>(node - first_) * stride_;
  }
  /// The members that an image saves (image.hpp): all but the capacity and scratch memory, and of the rows only those
  /// of the window (in_use()).
  [[nodiscard]] static auto members(ContactMetric& self) noexcept {
    auto& [capacity, first, last, stride, table, row, d, l1, l2] = self;
    return std::tie(first, last, stride);
  }
  [[nodiscard]] std::span<float> in_use() noexcept {
    const auto nodes = static_cast<std::size_t>(std::max(0, last_ - first_ + 1));
    return {row_.data(), std::min(row_.size(), nodes * stride_ + (nodes > 0 ? 8 : 0))};
  }

 private:
  int capacity_ = 0, first_ = 1, last_ = 0;
  std::size_t stride_ = 0;
  void factor(const Mesh& mesh, const Material& material, double dt_s) noexcept;
  [[nodiscard]] bool invert(TickTime& time) noexcept;

  std::vector<double> table_;
  std::vector<float> row_;           // table_ in single precision
  std::vector<double> d_, l1_, l2_;  // scalar LDL^T
};

}  // namespace ligature::physics::rod
