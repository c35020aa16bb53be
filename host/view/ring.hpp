#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ligature::host::view {

/// The last `capacity` items. Each has a running number, so that every reader can keep its own position.
template <class T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) : items_(capacity) {}

  void push(const T& item) {
    items_[static_cast<std::size_t>(end_) % items_.size()] = item;
    ++end_;
  }
  void clear() { begin_ = end_; }  // numbers continue, so that an old position never refers to a new item

  /// Number of the oldest item kept, and of the next one to be pushed.
  [[nodiscard]] std::int64_t begin() const {
    const auto oldest = end_ - static_cast<std::int64_t>(items_.size());
    return oldest > begin_ ? oldest : begin_;
  }
  [[nodiscard]] std::int64_t end() const { return end_; }
  /// @pre begin() <= number < end().
  [[nodiscard]] const T& operator[](std::int64_t number) const {
    return items_[static_cast<std::size_t>(number) % items_.size()];
  }

 private:
  std::vector<T> items_;
  std::int64_t begin_ = 0, end_ = 0;
};

}  // namespace ligature::host::view
