#include "host/gap_counter.hpp"

#include <iterator>

namespace ligature::host {

bool GapCounter::add(std::int64_t number) {
  if (is_empty()) {
    first_ = last_ = number;
  } else if (number > last_) {
    open_hole({last_ + 1, number - 1});
    last_ = number;
  } else if (number < first_) {
    open_hole({number + 1, first_ - 1});
    first_ = number;
    ++late_;
  } else if (fill(number)) {
    ++late_;
  } else {
    ++duplicates_;
    return false;
  }
  ++received_;
  return true;
}

void GapCounter::open_hole(TickRange hole) {
  if (hole.size() <= 0) return;
  holes_.emplace(hole.first, hole.last);
  missing_ += hole.size();
}

bool GapCounter::fill(std::int64_t number) {
  const auto after = holes_.upper_bound(number);
  if (after == holes_.begin()) return false;
  const auto hole = std::prev(after);
  const auto [first, last] = *hole;
  if (number > last) return false;
  holes_.erase(hole);
  missing_ -= last - first + 1;
  open_hole({first, number - 1});
  open_hole({number + 1, last});
  return true;
}

std::vector<TickRange> GapCounter::missing_ranges() const {
  std::vector<TickRange> ranges;
  ranges.reserve(holes_.size());
  for (const auto& [first, last] : holes_) ranges.push_back({first, last});
  return ranges;
}

}  // namespace ligature::host
