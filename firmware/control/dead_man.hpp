#pragma once
// Whether a pressed dead-man is a wish for force, or a button that somebody forgot, taped down or never let go of.

#include <algorithm>

namespace ligature::control {

/// A press counts when the button was seen released before it: since the start, since the last stop and since the last
/// fault's reset. Released means kReleased fresh samples in a row, so that one wrong bit is no release. O(1).
class DeadMan {
 public:
  static constexpr int kReleased = 3;  ///< samples, 1 ms each

  /// A new sample of the button, late or in time.
  void see(bool pressed) noexcept {
    pressed_ = pressed;
    released_ = pressed ? 0 : std::min(released_ + 1, kReleased);
    if (released_ == kReleased) needs_new_press_ = false;
  }
  /// Force is gone and must not come back by itself: what is pressed now does not count, nor a release before now.
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
