#pragma once
// Array of floats aligned to a cache line, so that an aligned group of eight never spans two lines.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "firmware/physics/members.hpp"

namespace ligature::physics::rod {

class Floats {
 public:
  void resize(std::size_t n) { size_ = n, lines_.resize((n + 15) / 16); }
  [[nodiscard]] float* data() noexcept { return lines_.data()->at; }
  [[nodiscard]] const float* data() const noexcept { return lines_.data()->at; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  void clear() noexcept { std::fill(lines_.begin(), lines_.end(), Line{}); }  ///< all zero
  LIGATURE_MEMBERS(Floats, lines, size)

 private:
  struct alignas(64) Line {
    float at[16] = {};
    LIGATURE_MEMBERS(Line, numbers)
  };
  std::vector<Line> lines_;
  std::size_t size_ = 0;
};

}  // namespace ligature::physics::rod
