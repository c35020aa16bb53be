#pragma once
// Interface of an operator that sees the thread and moves both hands.

#include <array>

#include "sim_device/operator/sight.hpp"

namespace ligature::lab {

/// act() is called once a millisecond, in order of time, so that it may keep state. It must depend only on its inputs
/// (seed included): repeated runs are then bit-identical.
class SeeingOperator {
 public:
  virtual ~SeeingOperator() = default;

  /// Position of the tools before the start, world metres. @pre within the devices' reach.
  [[nodiscard]] virtual std::array<sim::Vec3, 2> start_W_m() const = 0;
  /// @param sight what is seen and felt now. Its time t_s counts from when the drives of both hands are first on. The
  /// thread's points are valid during the call only.
  [[nodiscard]] virtual std::array<sim::HandWish, 2> act(const sim::Sight& sight) = 0;
  /// True: finished; the dead-men are released one second later.
  [[nodiscard]] virtual bool is_done() const = 0;
};

}  // namespace ligature::lab
