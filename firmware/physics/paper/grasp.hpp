#pragma once

#include <limits>

#include "firmware/physics/closing.hpp"
#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/thread.hpp"
#include "firmware/physics/simulation.hpp"

namespace ligature::physics {

/// Virtual coupling between a tool (position p_T, velocity v_T) and the node that it holds (p_G, v_G, mass m): the
/// thread's side of the paper's coupling (III.A.2). The force on the node is
///   f = K' (p_T - p_G) + B' (v_T - v_G),   B' = B / (1 + dt B / m),   K' = min(K, m / (2 dt^2))
/// The force on the hand is -f. B' is the damper B integrated implicitly over the time step dt. K' is the spring K,
/// unless K is too stiff for the time step (with Table I it is not: dt^2 K / m = 0.024). So no spring or damper is
/// unstable, and at rest the force is exactly K times the distance.
struct Coupling {
  double N_per_m = 0.0;
  double N_s_per_m = 0.0;
  LIGATURE_MEMBERS(Coupling, K, B)
};

/// Force of the coupling on the held node, N. Without side effects.
[[nodiscard]] inline V3<double> coupling_force_N(const Coupling& c, double inverse_mass_per_kg, double step_s,
                                                 const V3<double>& p_WT, const V3<double>& v_WT, const V3<double>& p,
                                                 const V3<double>& v) noexcept {
  const double spring = smaller(c.N_per_m, 0.5 / (inverse_mass_per_kg * step_s * step_s));
  const double damper = c.N_s_per_m / (1.0 + step_s * c.N_s_per_m * inverse_mass_per_kg);
  return spring * (p_WT - p) + damper * (v_WT - v);
}

/// The node that each hand holds. A closing hand takes the nearest node that is neither fixed nor held, if the thread
/// next to this node is within reach. A thread that is farther away than its radius is brought to the hand smoothly
/// (closing.hpp). An opening hand releases its node.
class Grasp {
 public:
  Grasp() = default;
  explicit Grasp(double reach_m) : reach_m_(reach_m) {}

  void update(const std::array<ToolInput, 2>& tools, const ThreadModel& model, const ThreadState& state) noexcept;
  void release_all() noexcept { *this = Grasp(reach_m_); }
  /// Advances the closing motion of both hands by one tick.
  void step(double tick_s) noexcept {
    for (Closing& c : closing_) c.step(tick_s);
  }
  [[nodiscard]] int node(int hand) const noexcept { return node_[static_cast<std::size_t>(hand)]; }
  [[nodiscard]] const Closing& closing(int hand) const noexcept { return closing_[static_cast<std::size_t>(hand)]; }
  LIGATURE_MEMBERS(Grasp, reach_m, closing, node, closed)

 private:
  void close(std::size_t hand, const ToolInput& tool, const ThreadModel& model, const ThreadState& state) noexcept;

  double reach_m_ = std::numeric_limits<double>::infinity();
  std::array<Closing, 2> closing_;
  std::array<int, 2> node_{-1, -1};
  std::array<bool, 2> closed_{false, false};
};

}  // namespace ligature::physics
