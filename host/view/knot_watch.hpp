#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <thread>
#include <vector>

#include "host/knot/recognise.hpp"
#include "host/view/picture.hpp"

namespace ligature::host::view {

/// The part of the thread that contains the knot.
struct KnotCore {
  std::size_t first = 0, last = 0;  // nodes, inclusive; both 0 when there is no knot
};

/// Finds a short piece of the thread that contains the knot: cuts both ends off while the rest keeps the same knot, by
/// two bisections, about 2 log2(n) recognitions. The piece is not always the shortest, because the knot type can change
/// back and forth while a loose, tangled thread is cut.
[[nodiscard]] KnotCore find_core(std::span<const std::array<double, 3>> points, const knot::KnotResult& whole);

/// Names the knot of the newest shape 20 times a second, on its own thread of execution, and gives it to the picture.
class KnotWatch {
 public:
  explicit KnotWatch(Picture& picture);

 private:
  void watch(const std::stop_token& stop);

  Picture& picture_;
  std::jthread thread_;
};

}  // namespace ligature::host::view
