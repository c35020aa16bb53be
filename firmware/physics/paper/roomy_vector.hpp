#pragma once
// A vector that keeps its capacity when it is copied.

#include <vector>

namespace ligature::physics {

/// A copy of a std::vector has only the capacity of its elements. A solver that treats capacity as a limit, to avoid
/// allocation, would then drop contacts in a copied simulation. A copy of this one has the capacity of the original.
template <class T>
class RoomyVector : public std::vector<T> {
 public:
  RoomyVector() = default;
  RoomyVector(const RoomyVector& other) : std::vector<T>() { *this = other; }
  RoomyVector(RoomyVector&&) noexcept = default;
  RoomyVector& operator=(const RoomyVector& other) {
    if (this == &other) return *this;
    this->reserve(other.capacity());
    this->assign(other.begin(), other.end());
    return *this;
  }
  RoomyVector& operator=(RoomyVector&&) noexcept = default;
  ~RoomyVector() = default;
};

}  // namespace ligature::physics
