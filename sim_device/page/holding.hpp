#pragma once
// Decides which sender may steer a hand: one at a time, and no replay of a recording.

#include <cstdint>
#include <functional>
#include <utility>

#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// Identification in a hand_wish_t (protocol/lcm/hand_wish_t.lcm).
struct Claim {
  std::int64_t session = 0, owner = 0, sequence = 0;
  bool leaves = false;
};

/// The first sender that uses the present session becomes the hand's owner, until it leaves or is silent for
/// kFreeAfter. Then the session changes, and messages of the old session are ignored.
class Holding {
 public:
  static constexpr Time kFreeAfter = std::chrono::seconds(5);
  using FreshNumber = std::function<std::int64_t()>;  ///< unpredictable and never repeated

  explicit Holding(FreshNumber fresh) : fresh_(std::move(fresh)) { end(); }

  /// @return whether the message with this claim may be applied; also true for the last message, by which the owner
  /// leaves.
  [[nodiscard]] bool accept(const Claim& claim, Time now) {
    look(now);
    if (claim.session != session_ || claim.owner == 0 || claim.sequence <= sequence_) return false;
    if (owner_ != 0 && claim.owner != owner_) return false;
    owner_ = claim.owner;
    sequence_ = claim.sequence;
    heard_ = now;
    if (claim.leaves) end();
    return true;
  }

  /// Ends the ownership of a sender that has been silent for too long.
  void look(Time now) {
    if (owner_ != 0 && now - heard_ > kFreeAfter) end();
  }

  [[nodiscard]] std::int64_t session() const noexcept { return session_; }
  [[nodiscard]] std::int64_t owner() const noexcept { return owner_; }
  [[nodiscard]] std::int64_t sequence() const noexcept { return sequence_; }

 private:
  void end() {
    session_ = fresh_();
    owner_ = sequence_ = 0;
  }

  FreshNumber fresh_;
  std::int64_t session_ = 0, owner_ = 0, sequence_ = 0;
  Time heard_{};
};

}  // namespace ligature::sim
