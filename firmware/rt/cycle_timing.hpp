#pragma once
// Timing statistics of all cycles of a run, in constant memory.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace ligature::rt {

/// Statistics of durations in ns: exact count and maximum, and a histogram with 32 bins per power of two. A quantile is
/// at most 1/32 too high and never too low. 16 kB; O(1) per sample; no allocation.
class DurationStatistics {
 public:
  void add(std::int64_t value_ns) noexcept {
    const std::int64_t v = std::max<std::int64_t>(value_ns, 0);
    ++count_;
    max_ = std::max(max_, v);
    ++bins_[bin_of(static_cast<std::uint64_t>(v))];
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::int64_t max_ns() const noexcept { return max_; }

  /// @param q in 0 .. 1. @return the upper edge of the bin that holds the q-quantile, at most max_ns(); 0 when empty.
  [[nodiscard]] std::int64_t quantile_ns(double q) const noexcept {
    if (count_ == 0) return 0;
    const double wanted = std::clamp(q, 0.0, 1.0) * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      seen += bins_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted) return std::min(upper_edge(i), max_);
    }
    return max_;
  }

 private:
  static constexpr std::size_t kSub = 32;  // bins per power of two
  static constexpr std::size_t kBins = kSub * 60;

  static std::size_t bin_of(std::uint64_t v) noexcept {
    if (v < kSub) return static_cast<std::size_t>(v);
    const auto shift = static_cast<std::size_t>(std::bit_width(v)) - 6;  // keeps the six leading bits
    return shift * kSub + static_cast<std::size_t>(v >> shift);
  }
  static std::int64_t upper_edge(std::size_t i) noexcept {
    if (i < 2 * kSub) return static_cast<std::int64_t>(i);
    const std::size_t shift = i / kSub - 1;
    return static_cast<std::int64_t>(((static_cast<std::uint64_t>(i - shift * kSub) + 1) << shift) - 1);
  }

  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
  std::array<std::uint64_t, kBins> bins_{};
};

/// Timing of a run. Missed: a cycle that finished after the end of its period. Lost: a period in which nothing was
/// done.
struct CycleTiming {
  DurationStatistics wakeup;     ///< from scheduled time to awake
  DurationStatistics control;    ///< from awake to RPDOs written
  DurationStatistics execution;  ///< from awake to tools handed to the physics
  DurationStatistics work;       ///< CPU time of the loop's thread after the samples, without waiting
  std::uint64_t deadline_misses = 0;
  DurationStatistics thread;       ///< CPU time of the physics per tick
  std::uint64_t overworked = 0;    ///< ticks whose `work` exceeds what the bus leaves of a period
  std::uint64_t thread_late = 0;   ///< ticks whose physics was not done when the next samples came
  std::uint64_t thread_cut = 0;    ///< physics ticks ended by the deadline
  double thread_lost_ticks = 0.0;  ///< time in which the simulated thread was not moved, in ticks
  std::uint64_t periods_lost = 0;
};

}  // namespace ligature::rt
