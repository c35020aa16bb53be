#pragma once
#include <cmath>

namespace ligature::lab {

/// A timer for actions at multiples of a period that need not be a multiple of the tick.
class Every {
 public:
  explicit Every(double period_s) : period_s_(period_s) {}
  bool is_due(double t_s, double tick_s) {
    if (t_s + 0.5 * tick_s < next_ * period_s_) return false;
    next_ = std::floor(t_s / period_s_ + 0.5 * tick_s / period_s_) + 1.0;
    return true;
  }

 private:
  double period_s_;
  double next_ = 1.0;
};

}  // namespace ligature::lab
