#pragma once
// Draws a scene's loose knot tight, holds it, releases it and waits.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/knot/recognise.hpp"
#include "protocol/scene/scene.hpp"
#include "tests/bench/rod/tick_times.hpp"

namespace ligature::bench {

struct Pull {
  double speed_m_per_s = 0.2, force_N = 5.0;
  bool sudden = false;     ///< the hands let go under full force; else they move back first
  int hands = 2;           ///< number of hands that pull
  double tremble_m = 0.0;  ///< amplitude of a tremble of both hands at 9 Hz, across the pull
};

/// Settings shared by all pulls of a study.
struct PullOptions {
  double hold_s = 0.7;        ///< length of the hold, after 0.3 s for the thread to come to rest
  double wait_s = 5.0;        ///< after the release
  double work_k = 0.0;        ///< Numerics::work in thousand instructions; 0: the default
  std::string shapes;         ///< folder for the thread's shapes at start, hold and end; empty: none
  bool disturbances = false;  ///< record for each tick what disturbed it (tick_times.hpp)
};

struct PullResult {
  knot::KnotResult begun, left;
  int guard = 0;
  double pull_d = 0.0, hold_d = 0.0, after_d = 0.0;  ///< largest penetration in each stage, in thread diameters
  /// Share of each stage's time in which the thread was not moved (time lost). hold_lost: in the hold and the 0.3 s
  /// before it; held_lost: in the hold alone
  double pull_lost = 0.0, hold_lost = 0.0, held_lost = 0.0, after_lost = 0.0;
  double strain = 0.0, tension_N = 0.0;    ///< measured in the hold
  double turn_rad = 0.0, segment_d = 0.0;  ///< sharpest turn and longest segment in contact, measured in the hold
  double chatter = 0.0, sliding = 0.0;     ///< chatter of the force (chatter.hpp) in the hold, during the pull
  double held_J = 0.0, after_J = 0.0;      ///< largest rise of the energy in a tick: in the hold, after the release
  std::vector<Tick> ticks;

  [[nodiscard]] bool kept() const { return left.type == begun.type && left.handedness == begun.handedness; }
};

class Puller {
 public:
  Puller(const scene::Scene& scene, physics::rod::RodSimulation sim, const PullOptions& options);
  [[nodiscard]] PullResult run(const Pull& pull);

 private:
  [[nodiscard]] double force() const;
  [[nodiscard]] std::vector<std::array<double, 3>> points() const;
  void save(const std::string& name) const;
  /// Moves `hands` hands apart at `speed` each, m/s, for `seconds`. Ends earlier if until_N > 0 and the force exceeds
  /// it, or if until_N < 0 and the force falls below -until_N.
  void phase(double seconds, double speed, int hands, double until_N);
  void tick();
  /// Share of the ticks' time in which the thread was not moved, since the previous call.
  [[nodiscard]] double lost();
  [[nodiscard]] double energy_J() const { return sim_.rod().all_J(sim_.rod().energy()); }
  /// Largest turn at a node in contact, rad, and longest segment in contact, in diameters.
  [[nodiscard]] std::pair<double, double> sharpness() const;

  scene::Scene scene_;
  physics::rod::RodSimulation sim_;
  PullOptions options_;
  std::array<physics::ToolInput, 2> tools_{};
  std::vector<Tick> ticks_;
  std::vector<double> forces_;
  double penetration_ = 0.0, lost_ = 0.0, rise_J_ = 0.0, tremble_m_ = 0.0;
  std::size_t lost_from_ = 0;  // first tick that the next call of lost() evaluates
  int guard_ = 0;
};

}  // namespace ligature::bench
