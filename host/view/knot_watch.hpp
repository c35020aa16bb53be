#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <thread>
#include <vector>

#include "host/knot/recognise.hpp"
#include "host/view/picture.hpp"

namespace ligature::host::view {

/// Where in the thread the knot sits.
struct KnotCore {
  std::size_t first = 0, last = 0;  // nodes, inclusive; both 0 when there is no knot
};

/// The shortest piece of the thread, by cutting ends off while the rest has the same knot: two bisections, so about
/// 2 log2(n) recognitions. Not always the very shortest: cutting is not monotonous for loose, tangled threads.
[[nodiscard]] KnotCore find_core(std::span<const std::array<double, 3>> points, const knot::KnotResult& whole);

/// Names the knot of the newest shape 20 times a second on a thread of its own and tells the picture.
class KnotWatch {
 public:
  explicit KnotWatch(Picture& picture);

 private:
  void watch(const std::stop_token& stop);

  Picture& picture_;
  std::jthread thread_;
};

}  // namespace ligature::host::view
