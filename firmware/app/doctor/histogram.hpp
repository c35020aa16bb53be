#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace ligature::app {

/// Histogram of latencies in bins of 1 us up to 10 ms, with the largest latency. add() is O(1) and does not allocate.
class LatencyHistogram {
 public:
  static constexpr std::size_t kBins = 10'000;  // bin i holds [i, i + 1) us; longer ones are counted in over()

  void add(std::int64_t latency_ns) noexcept {
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(latency_ns, 0));
    const std::uint64_t bin = ns / 1000;
    if (bin < kBins)
      ++bins_[bin];
    else
      ++over_;
    ++count_;
    max_ns_ = std::max(max_ns_, ns);
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::uint64_t over() const noexcept { return over_; }
  [[nodiscard]] double max_us() const noexcept { return 1e-3 * static_cast<double>(max_ns_); }
  [[nodiscard]] const std::vector<std::uint64_t>& bins() const noexcept { return bins_; }

  /// The q-quantile, rounded up to the edge of its bin but at most max_us(); 0 when the histogram is empty.
  [[nodiscard]] double quantile_us(double q) const noexcept {
    const double wanted = q * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      seen += bins_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted) return std::min(static_cast<double>(i + 1), max_us());
    }
    return max_us();
  }

  /// Number of latencies in bins that begin at `us` or later.
  [[nodiscard]] std::uint64_t from(double us) const noexcept {
    std::uint64_t all = over_;
    for (std::size_t i = 0; i < kBins; ++i)
      if (static_cast<double>(i) >= us) all += bins_[i];
    return all;
  }

  /// Restores one bin from a stored report. Bins beyond the range are ignored.
  void restore(std::size_t bin, std::uint64_t count) noexcept {
    if (bin >= kBins) return;
    bins_[bin] += count;
    count_ += count;
  }
  void restore_rest(std::uint64_t over, double max_us) noexcept {
    over_ += over;
    count_ += over;
    max_ns_ = static_cast<std::uint64_t>(std::max(0.0, max_us * 1e3));
  }

 private:
  std::vector<std::uint64_t> bins_ = std::vector<std::uint64_t>(kBins);
  std::uint64_t count_ = 0, over_ = 0, max_ns_ = 0;
};

}  // namespace ligature::app
