#pragma once
// How much longer a tick of the thread may take. Physics has no clock: it is told.

#include <algorithm>
#include <cstdint>
#include <limits>

namespace ligature::physics {

/// What a tick is given along with its tools. By default there is time without end, as in every offline run.
class TimeLeft {
 public:
  using Teller = std::int64_t (*)(void*) noexcept;  ///< ns until the tick must have ended; may be negative

  TimeLeft() = default;
  /// Whoever calls tick() keeps `context` alive until it returns.
  TimeLeft(Teller teller, void* context) noexcept : teller_(teller), context_(context) {}
  /// A tick done again: it ends where Diagnostics::cut_at says that it did, whatever the time.
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

/// Asks between pieces of a tick's work whether there is time for another one. Once the answer was no it stays no. The
/// answers are all that time does to a tick, and the questions depend on the thread alone, so the number of the first
/// no says everything: the same tools, and the same no, give the same tick to the bit.
///
/// A piece is begun only when there is time for the longest of late, and then for what ends a tick. Both are measured.
/// They fade, and no more counts than a piece can take: else what interrupts a tick would cost the ticks after it.
class TickTime {
 public:
  static constexpr std::int64_t kPiece_ns = 60'000;

  /// For those who have all the time there is: never asks, so everybody may share it.
  [[nodiscard]] static TickTime& endless() noexcept {
    static TickTime time;
    return time;
  }

  /// @param piece_ns  the most that may lie between two questions, and between the last one and the end.
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

  /// The tick has ended.
  void end() noexcept {
    if (left_.has_teller()) tail_ns_ = std::max(tail_ns_, std::min(last_ns_ - left_.ns(), piece_ns_));
  }

  /// Number of the question that was answered with no, from 0; -1: none was.
  [[nodiscard]] int cut_at() const noexcept { return cut_at_; }
  [[nodiscard]] std::int64_t longest_ns() const noexcept { return longest_ns_; }

 private:
  static constexpr std::int64_t kFade = 8;  // a share of 1 / kFade goes in each tick

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
  std::int64_t last_ns_ = 0;     // what was left at the last question
  std::int64_t longest_ns_ = 0;  // between two questions
  std::int64_t tail_ns_ = 0;     // from the last question to the end of the tick
};

}  // namespace ligature::physics
