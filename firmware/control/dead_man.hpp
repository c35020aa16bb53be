#pragma once
// Decides whether a pressed dead-man button counts. A button that is taped down, or that was never released, must not
// count.

#include <algorithm>

namespace ligature::control {

/// A press counts only if the button was seen released before: since the start, since the last stop and since the last
/// fault's reset. A release is kReleased fresh samples in a row without a press, so that one wrong bit is no release.
/// O(1).
class DeadMan {
 public:
  static constexpr int kReleased = 3;  ///< samples, 1 ms each

  /// Processes a new sample of the button, also one that arrives late.
  void see(bool pressed) noexcept {
    pressed_ = pressed;
    released_ = pressed ? 0 : std::min(released_ + 1, kReleased);
    if (released_ == kReleased) needs_new_press_ = false;
  }
  /// Call after a stop or fault: a press counts again only after a new release.
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
