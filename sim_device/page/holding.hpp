#pragma once
// Who may steer a hand: one at a time, and nobody from a recording.

#include <cstdint>
#include <functional>
#include <utility>

#include "sim_device/deadline.hpp"

namespace ligature::sim {

/// What a wish says of itself (protocol/lcm/hand_wish_t.lcm).
struct Claim {
  std::int64_t session = 0, owner = 0, sequence = 0;
  bool leaves = false;
};

/// The first who says the session has the hand, until he leaves or is silent for kFreeAfter. Then the session is
/// another one, and all that was said in the one before is worth nothing.
class Holding {
 public:
  static constexpr Time kFreeAfter = std::chrono::seconds(5);
  using FreshNumber = std::function<std::int64_t()>;  ///< never the same twice, not to be guessed

  explicit Holding(FreshNumber fresh) : fresh_(std::move(fresh)) { end(); }

  /// @return whether what came with the claim is to be done. Who leaves is done with, too.
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

  /// Lets go of who has been silent for too long.
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
