#pragma once
#include <cstdint>
#include <map>
#include <vector>

namespace ligature::host {

/// Tick numbers first .. last, both included.
struct TickRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  bool operator==(const TickRange&) const = default;
  [[nodiscard]] std::int64_t size() const { return last - first + 1; }
};

/// Finds the missing numbers of a sequence that should rise by one each time. A jump opens a hole; a late number fills
/// its place in the hole; a number received before is a duplicate.
/// Invariant: received() + missing() = last() - first() + 1 as soon as one number came.
/// Cost: O(1) for the next number in sequence, O(log holes) for one out of order.
class GapCounter {
 public:
  /// @param number 0 .. 2^53 (message types hold less). @return false for a duplicate.
  bool add(std::int64_t number);

  [[nodiscard]] bool is_empty() const { return received_ == 0; }
  [[nodiscard]] std::int64_t first() const { return first_; }
  [[nodiscard]] std::int64_t last() const { return last_; }
  [[nodiscard]] std::int64_t received() const { return received_; }  ///< distinct numbers
  [[nodiscard]] std::int64_t missing() const { return missing_; }
  [[nodiscard]] std::int64_t duplicates() const { return duplicates_; }
  [[nodiscard]] std::int64_t late() const { return late_; }  ///< arrived after a larger number
  [[nodiscard]] std::vector<TickRange> missing_ranges() const;

 private:
  void open_hole(TickRange hole);
  bool fill(std::int64_t number);

  std::map<std::int64_t, std::int64_t> holes_;  // holes: first missing number -> last missing number
  std::int64_t first_ = 0, last_ = 0;
  std::int64_t received_ = 0, missing_ = 0, duplicates_ = 0, late_ = 0;
};

}  // namespace ligature::host
