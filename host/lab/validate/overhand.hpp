#pragma once
// A loose overhand knot to pull: built anywhere, in any thread.

#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {

/// Lays the thread as an overhand knot: tails along -x and +x, one loop of 2 pi loop_m above them, and three half turns
/// of the two strands about each other along its foot. Its excess length is then near 2 pi loop_m.
void lay_overhand(scene::Scene& scene, double loop_m);

/// Excess length of a knotted thread held at its ends, m: what is missing between the hands.
[[nodiscard]] double excess_m(const physics::Simulation& sim, double length_m);

/// Both hands on the ends; `apart` moves them along x.
class EndPull {
 public:
  explicit EndPull(physics::Simulation& sim);
  /// One tick while the hands part at speed each.
  void tick(double speed_m_per_s, double tick_s);
  /// Mean of the two hands' pulls, N.
  [[nodiscard]] double tension_N() const;
  [[nodiscard]] double distance_m() const { return tools_[1].p_WT.x() - tools_[0].p_WT.x(); }
  void let_go() { tools_[0].grip = tools_[1].grip = false; }

 private:
  physics::Simulation& sim_;
  Tools tools_;
};

}  // namespace ligature::validate
