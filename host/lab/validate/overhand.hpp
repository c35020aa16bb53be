#pragma once
// A loose overhand knot to pull: built anywhere, in any thread.

#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {

/// The curve of a loose overhand knot: tails along -x and +x, one loop of 2 pi loop_m above them, and three half turns
/// of the two strands about each other along its foot. Its excess length is then near 2 pi loop_m.
struct OverhandCurve {
  double length_m = 0.0, radius_m = 0.0, loop_m = 0.0;
  double half_m = 0.0;  ///< of the foot

  /// @param finest_m segments of the thread in the foot: a polygon needs a long one, to have the knot too.
  OverhandCurve(double length, double radius, double loop, double finest_m);
  [[nodiscard]] Vec3 at(double along) const;
  /// Where the middle of the foot is passed, first and last time, m along the thread.
  [[nodiscard]] std::array<double, 2> crossings_m() const;
};

/// Lays the scene's thread, equally spaced, along that curve.
void lay_overhand(scene::Scene& scene, double loop_m);

/// Both hands on the ends; `apart` moves them along x.
template <class Thread>  // physics::Simulation, or a model's own class with the same contract
class EndPull {
 public:
  explicit EndPull(Thread& sim) : sim_(sim), tools_(no_hands()) {
    tools_[0] = {sim.nodes_W().front(), Vec3::Zero(), true};
    tools_[1] = {sim.nodes_W().back(), Vec3::Zero(), true};
  }
  /// One tick while the hands part at speed each.
  void tick(double speed_m_per_s, double tick_s) {
    for (std::size_t h = 0; h < 2; ++h) {
      tools_[h].v_WT.x() = h == 0 ? -speed_m_per_s : speed_m_per_s;
      tools_[h].p_WT.x() += tick_s * tools_[h].v_WT.x();
    }
    proceed(sim_, tools_);
  }
  /// Mean of the two hands' pulls, N.
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
