#pragma once

#include <limits>

#include "firmware/physics/closing.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/physics/thread.hpp"

namespace ligature::physics {

/// Virtual coupling between a tool and the node it holds (paper III.A.2), thread side.
///   f = K' (p_T - p_G) + B' (v_T - v_G) on the node;  B' = B / (1 + dt B / m),  K' = min(K, m / (2 dt^2))
/// B' is the damper taken at the end of the step; K' is K unless K is out of proportion (Table I: dt^2 K / m = 0.024).
/// So neither a strong damper nor a stiff spring is unstable, and a hand at rest feels exactly K times the distance.
/// The hand feels -f.
struct Coupling {
  double N_per_m = 0.0;
  double N_s_per_m = 0.0;
};

/// Force on the held node, N; pure.
[[nodiscard]] inline V3<double> coupling_force_N(const Coupling& c, double inverse_mass_per_kg, double step_s,
                                                 const V3<double>& p_WT, const V3<double>& v_WT, const V3<double>& p,
                                                 const V3<double>& v) noexcept {
  const double spring = smaller(c.N_per_m, 0.5 / (inverse_mass_per_kg * step_s * step_s));
  const double damper = c.N_s_per_m / (1.0 + step_s * c.N_s_per_m * inverse_mass_per_kg);
  return spring * (p_WT - p) + damper * (v_WT - v);
}

/// What each hand holds. A hand that closes takes the nearest node that is neither fixed nor held, if the thread beside
/// it is within reach, and brings it to itself if it is further off than its radius (closing.hpp); one that opens lets
/// go.
class Grasp {
 public:
  Grasp() = default;
  explicit Grasp(double reach_m) : reach_m_(reach_m) {}

  void update(const std::array<ToolInput, 2>& tools, const ThreadModel& model, const ThreadState& state) noexcept;
  void release_all() noexcept { *this = Grasp(reach_m_); }
  /// A tick has passed.
  void step(double tick_s) noexcept {
    for (Closing& c : closing_) c.step(tick_s);
  }
  [[nodiscard]] int node(int hand) const noexcept { return node_[static_cast<std::size_t>(hand)]; }
  [[nodiscard]] const Closing& closing(int hand) const noexcept { return closing_[static_cast<std::size_t>(hand)]; }

 private:
  void close(std::size_t hand, const ToolInput& tool, const ThreadModel& model, const ThreadState& state) noexcept;

  double reach_m_ = std::numeric_limits<double>::infinity();
  std::array<Closing, 2> closing_;
  std::array<int, 2> node_{-1, -1};
  std::array<bool, 2> closed_{false, false};
};

}  // namespace ligature::physics
