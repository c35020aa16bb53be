#pragma once
// Builds a loose overhand knot in any thread, and pulls it.

#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {

/// The curve of a loose overhand knot: tails along -x and +x, above them one loop of length 2 pi loop_m, and along its
/// foot three half turns of the two strands about each other. The excess length is close to 2 pi loop_m.
struct OverhandCurve {
  double length_m = 0.0, radius_m = 0.0, loop_m = 0.0;
  double half_m = 0.0;  ///< half the length of the foot

  /// @param finest_m length of the thread's segments in the foot. The foot is made long enough for a polygon of such
  /// segments to contain the knot.
  OverhandCurve(double length, double radius, double loop, double finest_m);
  [[nodiscard]] Vec3 at(double along) const;
  /// Distances along the thread at which the middle of the foot is passed first and last, m.
  [[nodiscard]] std::array<double, 2> crossings_m() const;
};

/// Lays the scene's thread along that curve, nodes equally spaced.
void lay_overhand(scene::Scene& scene, double loop_m);

/// Both hands hold the ends; tick() moves them apart along x.
template <class Thread>  // Thread: physics::Simulation, or a class with the same interface
class EndPull {
 public:
  explicit EndPull(Thread& sim) : sim_(sim), tools_(no_hands()) {
    tools_[0] = {sim.nodes_W().front(), Vec3::Zero(), true};
    tools_[1] = {sim.nodes_W().back(), Vec3::Zero(), true};
  }
  /// One tick in which each hand moves outwards at this speed.
  void tick(double speed_m_per_s, double tick_s) {
    for (std::size_t h = 0; h < 2; ++h) {
      tools_[h].v_WT.x() = h == 0 ? -speed_m_per_s : speed_m_per_s;
      tools_[h].p_WT.x() += tick_s * tools_[h].v_WT.x();
    }
    proceed(sim_, tools_);
  }
  /// Mean pull of the two hands, N.
  [[nodiscard]] double tension_N() const {
    return 0.5 * (sim_.hand(physics::Hand::kLeft).f_W.x() - sim_.hand(physics::Hand::kRight).f_W.x());
  }
  [[nodiscard]] double distance_m() const { return tools_[1].p_WT.x() - tools_[0].p_WT.x(); }
  void let_go() { tools_[0].grip = tools_[1].grip = false; }

 private:
  Thread& sim_;
  Tools tools_;
};

}  // namespace ligature::validate
