#pragma once
// A person who looks at the thread while both hands work it.

#include <array>

#include "sim_device/operator/sight.hpp"

namespace ligature::lab {

/// Asked once a millisecond, in order of time, so it may remember. Must depend on nothing but what it was told (seed
/// included): a run is then bit-identical however often it is repeated.
class SeeingOperator {
 public:
  virtual ~SeeingOperator() = default;

  /// Where the tools rest before the start, world metres. @pre within the devices' reach.
  [[nodiscard]] virtual std::array<sim::Vec3, 2> start_W_m() const = 0;
  /// @param sight what is seen and felt now; t_s = 0 when the drives of both hands first follow. The thread's points
  /// are valid during the call only.
  [[nodiscard]] virtual std::array<sim::HandWish, 2> act(const sim::Sight& sight) = 0;
  /// True: nothing more to do; the dead-men are let go a second later.
  [[nodiscard]] virtual bool is_done() const = 0;
};

}  // namespace ligature::lab
