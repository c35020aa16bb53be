#pragma once
// Columns of the inverse of a substep's matrix, on a range of nodes. A column is computed only when it is requested,
// because only nodes with contacts need theirs.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/solve/floats.hpp"
#include "firmware/physics/rod/vec.hpp"
#include "firmware/physics/rod/work.hpp"

namespace ligature::physics::rod {

class BandSolver;

/// Columns of Z = A^-1 on a range of nodes (the window), for the matrix A that BandSolver had factorised when take()
/// was called; later factorisations do not change them. A column costs as much as solving the window for three
/// right-hand sides, and is kept until the next take(). No allocation after reserve().
class BandColumns {
 public:
  static constexpr int kWidest = 640;        ///< most nodes in a window
  static constexpr std::size_t kBlock = 12;  ///< numbers per node: a 3 x 3 block, each column padded to four
  static constexpr std::size_t kRoom = std::size_t{192} * 256;  ///< most blocks, in all columns together

  void reserve();
  void forget() noexcept { last_ = -1, first_ = 0; }
  [[nodiscard]] bool covers(int first, int last) const noexcept { return first_ <= first && last <= last_; }
  [[nodiscard]] int first() const noexcept { return first_; }
  [[nodiscard]] int width() const noexcept { return last_ - first_ + 1; }

  /// Copies the solver's factors for the nodes first to last. @pre last - first < kWidest, and this range contains both
  /// core nodes of the solver, at which its two eliminations meet.
  void take(const BandSolver& solver, int first, int last) noexcept;

  /// Requests the column of a node, counted from first(). @return false if there is no room for it.
  [[nodiscard]] bool want(std::int32_t node) noexcept;
  [[nodiscard]] int missing() const noexcept { return static_cast<int>(wanted_.size()) - made_; }
  /// Computes the requested columns. @return false if the time was over first; the columns computed so far are kept.
  bool make_missing(TickTime& time = TickTime::endless()) noexcept;
  /// One column of Z: its 3 x 3 blocks for all nodes of the window. @param node counted from first(). @pre the column
  /// was requested and computed.
  [[nodiscard]] const float* column(std::int32_t node) const noexcept {
    return columns_.data() + static_cast<std::size_t>(place_[node]) * stride();
  }
  [[nodiscard]] std::size_t stride() const noexcept {
    return kBlock * ((static_cast<std::size_t>(width()) + 1) & ~std::size_t{1});
  }
  /// The members that an image saves (image.hpp): all but scratch memory, and of the columns only the computed ones
  /// (in_use()).
  [[nodiscard]] static auto members(BandColumns& self) noexcept {
    auto& [first, last, made, core, out, s_inverse, one, two, skip, between, next_h, x, place, wanted, columns] = self;
    return std::tie(first, last, made, core, out, s_inverse, one, two, skip, between, next_h, place, wanted);
  }
  [[nodiscard]] std::span<float> in_use() noexcept {
    return {columns_.data(), std::min(columns_.size(), static_cast<std::size_t>(made_) * stride())};
  }

 private:
  void solve(std::ptrdiff_t node) noexcept;
  /// Copies the factors of the `count` nodes next to the core on one side (Lane = 0: left, 1: right).
  template <int Lane>
  void take_chain(const BandSolver& solver, std::ptrdiff_t count) noexcept;

  int first_ = 0, last_ = -1, made_ = 0;
  std::ptrdiff_t core_ = 0;           // left core node, counted from first_
  std::vector<Mat> out_, s_inverse_;  // per node: -H^T and S^-1, factors of BandSolver
  std::vector<Mat> one_, two_;        // back substitution: factors of the nodes one and two places nearer to the core
  std::vector<double> skip_;          // coupling of nodes i and i + 2
  Mat between_, next_h_;
  std::vector<Mat> x_;                // the column that is being computed
  std::vector<std::int32_t> place_;   // index of each node's column, or -1
  std::vector<std::int32_t> wanted_;  // nodes of the requested columns
  Floats columns_;
};

}  // namespace ligature::physics::rod
