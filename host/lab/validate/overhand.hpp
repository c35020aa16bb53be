#pragma once
// Builds a loose overhand knot in any thread, and pulls it.

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/lab/validate/specimen.hpp"

namespace ligature::validate {

/// The curve of a loose overhand knot: tails along -x and +x, above them one loop of length 2 pi loop_m, and at its
/// foot the two strands, which make (2 `turns` + 1) half turns about each other. The excess length is close to 2 pi
/// loop_m.
struct OverhandCurve {
  double length_m = 0.0, radius_m = 0.0, loop_m = 0.0;
  double half_m = 0.0;              ///< half the length of the foot
  double aside_m = 1.2 * radius_m;  ///< distance of each strand from the middle of the foot
  int turns = 1;                    ///< 1: overhand knot; n: the strands make 2 n + 1 half turns about each other

  /// @param finest_m length of the thread's segments in the foot. The foot is made long enough for a polygon of such
  /// segments to contain the knot.
  OverhandCurve(double length, double radius, double loop, double finest_m);
  /// Makes the foot (where the strands wind round each other) at least 7 segments of length finest_m long.
  void suit(double finest_m);
  [[nodiscard]] Vec3 at(double along) const;
  /// Distances along the thread at which the middle of the foot is passed first and last, m.
  [[nodiscard]] std::array<double, 2> crossings_m() const;
};

/// Lays the scene's thread along that curve, nodes equally spaced.
void lay_overhand(scene::Scene& scene, double loop_m);

/// Bending stiffness of the suture of scenes/suture-3-0.toml, N m^2.
inline constexpr double kOverhandB_N_m2 = 4e-7;

/// A thread of the suture's radius with another bending stiffness, laid as an overhand knot, with air drag. The loop's
/// excess length (thread length less the distance of the ends) is 2 pi loop_m.
[[nodiscard]] scene::Scene knotted(const Subject& subject, double loop_m, double EI_N_m2, double friction);

/// The scene's thread laid along the curve, with its nodes concentrated in the braid, where the two strands wind round
/// each other, and in the pieces that enter the braid when the ends move by travel_m. Elsewhere a segment is longer by
/// `growth` times its distance from these nodes.
[[nodiscard]] physics::rod::RodSimulation gathered_knot(scene::Scene scene, OverhandCurve curve, double travel_m,
                                                        double growth = 0.25);

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
