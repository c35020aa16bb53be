#pragma once
// A vector that keeps its capacity when it is copied.

#include <vector>

namespace ligature::physics {

/// A std::vector whose copy keeps the original's capacity. A plain copy would have only as much as its elements need.
/// Solvers here never exceed a vector's capacity, to avoid allocation, so a copied simulation would drop contacts.
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
