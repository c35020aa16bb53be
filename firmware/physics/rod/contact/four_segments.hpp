#pragma once
// Four segments of the thread, stored by component, so that four pairs are measured at once.

#include <array>
#include <cstddef>

#include "firmware/physics/rod/contact/smooth.hpp"

namespace ligature::physics::rod {

/// number_of(0) to number_of(3).
template <class F>
[[nodiscard]] Lanes each(F number_of) noexcept {
  return Lanes{number_of(0), number_of(1), number_of(2), number_of(3)};
}

/// Four segments, which need not be different.
struct FourSegments {
  std::array<std::size_t, 4> j;  ///< the segments
  Vecs x, e;                     ///< their first nodes; the vectors to their second nodes

  FourSegments(const std::array<std::size_t, 4>& segments, const Vec* nodes) noexcept : j(segments) {
    x = four(nodes[j[0]], nodes[j[1]], nodes[j[2]], nodes[j[3]]);
    e = four(nodes[j[0] + 1], nodes[j[1] + 1], nodes[j[2] + 1], nodes[j[3] + 1]) - x;
  }
  [[nodiscard]] SmoothOf<Vecs, Lanes> smooth(const State& state, const Vec* corner) const noexcept {
    const Lanes one = Lanes{} + 1.0;
    return {x,
            e,
            four(corner[j[0]], corner[j[1]], corner[j[2]], corner[j[3]]),
            four(corner[j[0] + 1], corner[j[1] + 1], corner[j[2] + 1], corner[j[3] + 1]),
            one / each([&](std::size_t l) { return state.cut_before[j[l]]; }),
            one / each([&](std::size_t l) { return state.cut_after[j[l]]; })};
  }
};

}  // namespace ligature::physics::rod
