#pragma once
// Time limit of one tick of the thread's physics. The physics has no clock of its own: it queries one that the caller
// supplies.

#include <algorithm>
#include <cstdint>
#include <limits>

namespace ligature::physics {

/// The time limit that is passed to a tick. By default there is none, as in every offline run.
class TimeLeft {
 public:
  using Teller = std::int64_t (*)(void*) noexcept;  ///< ns until the tick must have ended; may be negative

  TimeLeft() = default;
  /// @param context  passed to `teller`; must stay valid until tick() returns
  TimeLeft(Teller teller, void* context) noexcept : teller_(teller), context_(context) {}
  /// For replaying a recorded tick: it ends at clock query `number` (Diagnostics::cut_at), whatever the time.
  [[nodiscard]] static TimeLeft until_question(int number) noexcept {
    TimeLeft again;
    again.question_ = number;
    return again;
  }

  [[nodiscard]] bool has_teller() const noexcept { return teller_ != nullptr; }
  [[nodiscard]] bool is_endless() const noexcept { return teller_ == nullptr && question_ < 0; }
  [[nodiscard]] int question() const noexcept { return question_; }
  [[nodiscard]] std::int64_t ns() const noexcept { return teller_(context_); }  ///< @pre has_teller()

 private:
  Teller teller_ = nullptr;
  void* context_ = nullptr;
  int question_ = -1;
};

/// Queries the clock between pieces of a tick's work: is there time for another piece? After the first "no" the answer
/// stays "no". Time influences a tick only through these answers, and where a tick queries depends only on the state of
/// the thread. So a tick can be reproduced bit for bit from the state at its start, its tools, and the number of the
/// first query that was answered "no".
///
/// A piece is begun only if the time left covers two measured durations: that of the longest recent piece, and that of
/// the work after the last query of a tick. These measured values decay from tick to tick and are at most piece_ns, so
/// that one interruption by the operating system does not shorten many later ticks.
class TickTime {
 public:
  static constexpr std::int64_t kPiece_ns = 60'000;

  /// A shared object without a time limit; it never queries a clock.
  [[nodiscard]] static TickTime& endless() noexcept {
    static TickTime time;
    return time;
  }

  /// @param piece_ns  longest time of one piece of work, and of the work after the last query
  void start(const TimeLeft& left, std::int64_t piece_ns = kPiece_ns) noexcept {
    left_ = left;
    piece_ns_ = piece_ns;
    asked_ = 0;
    cut_at_ = -1;
    longest_ns_ -= longest_ns_ / kFade;
    tail_ns_ -= tail_ns_ / kFade;
    if (left_.has_teller()) last_ns_ = left_.ns();
  }

  /// Is there time for another piece?
  [[nodiscard]] bool allows() noexcept { return left_.is_endless() || ask(); }
  [[nodiscard]] bool is_over() const noexcept { return cut_at_ >= 0; }

  /// Call at the end of the tick: measures the time since the last query.
  void end() noexcept {
    if (left_.has_teller()) tail_ns_ = std::max(tail_ns_, std::min(last_ns_ - left_.ns(), piece_ns_));
  }

  /// Number of the first query that was answered "no", counted from 0; -1: none was.
  [[nodiscard]] int cut_at() const noexcept { return cut_at_; }

 private:
  static constexpr std::int64_t kFade = 8;  // measured durations decay by 1 / kFade per tick

  bool ask() noexcept {
    if (is_over()) return false;
    const int question = asked_++;
    bool over = false;
    if (left_.has_teller()) {
      const std::int64_t now_ns = left_.ns();
      longest_ns_ = std::max(longest_ns_, std::min(last_ns_ - now_ns, piece_ns_));
      last_ns_ = now_ns;
      over = now_ns <= longest_ns_ + tail_ns_;
    } else {
      over = question >= left_.question();
    }
    if (over) cut_at_ = question;
    return !over;
  }

  TimeLeft left_;
  int asked_ = 0, cut_at_ = -1;
  std::int64_t piece_ns_ = kPiece_ns;
  std::int64_t last_ns_ = 0;     // time left at the last query
  std::int64_t longest_ns_ = 0;  // longest recent time between two queries
  std::int64_t tail_ns_ = 0;     // longest recent time from the last query to the end of the tick
};

}  // namespace ligature::physics
