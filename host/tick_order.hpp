#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "ligature_msg/tick_t.hpp"

namespace ligature::host {

/// Sorts late ticks into their place. The recorder fills a gap within seconds, so a window of a few thousand ticks
/// suffices; a tick that is later still is passed on out of order.
/// Constant memory; O(log window) for a tick after a gap, O(1) for one in sequence.
class TickOrder {
 public:
  static constexpr std::size_t kWindow = 8192;

  /// @param emit is called for every tick whose place in the order is known.
  template <class Emit>
  void add(const ligature_msg::tick_t& tick, Emit&& emit) {
    if (waiting_.empty() && (next_ < 0 || tick.tick <= next_)) return pass(tick, emit);
    waiting_.emplace(tick.tick, tick);
    while (!waiting_.empty() && (waiting_.begin()->first <= next_ || waiting_.size() > kWindow)) pass_first(emit);
  }

  /// Passes on everything that waits; no more ticks follow.
  template <class Emit>
  void flush(Emit&& emit) {
    while (!waiting_.empty()) pass_first(emit);
    next_ = -1;
  }

 private:
  template <class Emit>
  void pass(const ligature_msg::tick_t& tick, Emit& emit) {
    if (tick.tick >= next_) next_ = tick.tick + 1;
    emit(tick);
  }
  template <class Emit>
  void pass_first(Emit& emit) {
    const auto first = waiting_.extract(waiting_.begin());
    pass(first.mapped(), emit);
  }

  std::map<std::int64_t, ligature_msg::tick_t> waiting_;
  std::int64_t next_ = -1;  // number of the tick that continues the sequence; -1: unknown
};

}  // namespace ligature::host
