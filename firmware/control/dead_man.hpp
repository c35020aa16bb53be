#pragma once
// Decides whether a pressed dead-man button counts: a button that is taped down or was never released must not.

#include <algorithm>

namespace ligature::control {

/// A press counts only if the button was seen released before it: after the start, after the last stop and after the
/// last fault's reset. "Released" needs kReleased fresh samples in a row, so that one wrong bit does not count as a
/// release. O(1).
class DeadMan {
 public:
  static constexpr int kReleased = 3;  ///< samples, 1 ms each

  /// Processes a new sample of the button, also one that arrives late.
  void see(bool pressed) noexcept {
    pressed_ = pressed;
    released_ = pressed ? 0 : std::min(released_ + 1, kReleased);
    if (released_ == kReleased) needs_new_press_ = false;
  }
  /// After a stop or fault: the present press, and any release so far, no longer count.
  void need_new_press() noexcept {
    needs_new_press_ = true;
    released_ = 0;
  }
  [[nodiscard]] bool counts() const noexcept { return pressed_ && !needs_new_press_; }

 private:
  bool pressed_ = false, needs_new_press_ = true;
  int released_ = 0;
};

}  // namespace ligature::control
