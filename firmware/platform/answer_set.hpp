#pragma once
// For drives that sample when they are asked and whose answers carry no time: which answers belong together, and how
// old they are.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "firmware/rt/rig_io.hpp"
#include "protocol/can/device_profile.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::platform {

/// The answers to the requests of one period: one part for each drive, and one for the button module. Only a complete
/// set is a sample. After an answer stayed away nobody is asked until it has come, or for kQuiet periods; so a late
/// answer cannot be taken for the answer to the next request. One that is later still could be. If the answers name
/// their requests, it is not: then only as many requests are open as have different names.
class AnswerSet {
 public:
  /// @param names by which the answers tell successive requests apart; 0: they do not
  explicit AnswerSet(int names = 0) noexcept : names_(names) {}

  static constexpr std::size_t kButtons = rt::kJoints, kParts = rt::kJoints + 1;
  enum class Answer : std::uint8_t {
    kInTime,
    kLate,     ///< to a request of an earlier period, or too many of them
    kUnasked,  ///< there were more answers than requests
  };

  /// Begins a period. @param may_ask false: nobody is asked in any case @return whether to ask all now
  bool begin_period(bool may_ask) noexcept {
    arrived_ = 0;
    if (age_ticks_ < std::numeric_limits<std::int32_t>::max()) ++age_ticks_;
    const bool are_used_up = names_ > 0 && std::ranges::max(owed_) >= names_;
    const int quiet = are_used_up ? kLost : outstanding_ != 0 ? kQuiet : 0;
    if (!may_ask || quiet_ < quiet) {
      quiet_ = std::min(quiet_ + 1, kLost);
      return false;
    }
    quiet_ = 0;
    outstanding_ = 0;
    return true;
  }
  void asked(std::size_t part) noexcept {
    outstanding_ |= 1U << part;
    owed_[part] = std::min(owed_[part] + 1, kMostOwed);
  }
  /// Strikes an answer off the list. A late one is no part of a set.
  [[nodiscard]] Answer take(std::size_t part) noexcept {
    const bool was_owed = owed_[part] > 0, in_time = (outstanding_ & 1U << part) != 0 && quiet_ == 0;
    if (was_owed) --owed_[part];
    outstanding_ &= ~(1U << part);
    if (!was_owed) return Answer::kUnasked;
    return in_time ? Answer::kInTime : Answer::kLate;
  }
  /// An answer in time, with the name of the last request. Answers keep their order, so older ones are lost.
  /// @return whether the set is complete by this part
  bool add(std::size_t part) noexcept {
    arrived_ |= 1U << part;
    if (names_ > 0) owed_[part] = 0;
    if (arrived_ != kAll) return false;
    valid_ = true;
    age_ticks_ = 0;
    return true;
  }
  [[nodiscard]] std::int32_t age_ticks() const noexcept { return age_ticks_; }
  [[nodiscard]] bool is_valid() const noexcept { return valid_; }  ///< there has been a set
  /// Whether the answer of this part is missing: from this period's set or, while nobody is asked, to the last request.
  [[nodiscard]] bool is_missing(std::size_t part) const noexcept {
    return age_ticks_ > 0 && ((quiet_ > 0 ? outstanding_ : ~arrived_) >> part & 1U) != 0;
  }

 private:
  static constexpr int kQuiet = 2;
  static constexpr int kLost = 20;     // periods after which an answer is lost: its sample would be too old (fault 11)
  static constexpr int kMostOwed = 8;  // so that few answers to nothing are excused after a drive was away
  static constexpr unsigned kAll = (1U << kParts) - 1U;
  int names_;
  unsigned outstanding_ = 0;  // parts that were asked for and have not come, one bit each
  unsigned arrived_ = 0;      // parts of this period's set
  int quiet_ = 0;             // periods since the last request
  std::array<int, kParts> owed_{};
  bool valid_ = false;
  std::int32_t age_ticks_ = 1;
};

/// A module of its own sends the buttons, as the word of docs/wire.md. Its counter is a sign of life: a frame that does
/// not change it is no sample.
class ButtonModule {
 public:
  static constexpr std::uint8_t kBytes = 2;
  static constexpr int kStillFrames = 10;  ///< in a row without a change of the counter: the module is stuck

  /// A frame of this length. @return whether it shows life
  bool take(const can::Frame& frame) noexcept {
    const auto word = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8U);
    const bool first = !std::exchange(has_word_, true);
    const bool moved = !first && can::profile::life_of(word) != can::profile::life_of(pending_);
    pending_ = word;
    still_frames_ = moved ? 0 : std::min(still_frames_ + 1, kStillFrames);
    return moved;
  }
  /// Counter of the newest frame.
  [[nodiscard]] std::uint8_t life() const noexcept { return can::profile::life_of(pending_); }
  void use() noexcept { word_ = pending_; }  ///< the set is complete
  void tell(rt::HandReading& r) const noexcept {
    r.buttons_stuck = still_frames_ >= kStillFrames;
    r.grip = (word_ & can::profile::kButtonGrip) != 0;
    r.dead_man = (word_ & can::profile::kButtonDeadMan) != 0;
    r.clutch = (word_ & can::profile::kButtonClutch) != 0;
  }

 private:
  std::uint16_t word_ = 0, pending_ = 0;
  bool has_word_ = false;  // a frame has come
  int still_frames_ = 0;
};

}  // namespace ligature::platform
