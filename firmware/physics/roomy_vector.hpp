#pragma once
// A vector whose capacity is its limit, also in a copy.

#include <vector>

namespace ligature::physics {

/// std::vector copies elements but not room: a copy of a reserved list is full at once, and a solver that drops what
/// does not fit would lose all its contacts. A copy of this one has the room of its original.
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
