#pragma once
// One pull of a scene's loose knot: drawn tight, held, let go, waited for.

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
  bool sudden = false;  ///< let go at once, else eased off first
  int hands = 2;        ///< that pull
};

/// For every pull of a study.
struct PullOptions {
  double hold_s = 0.7;        ///< after 0.3 s in which the thread comes to rest
  double wait_s = 5.0;        ///< after the release
  double work_k = 0.0;        ///< Numerics::work, thousand instructions; 0: the setting's own
  std::string shapes;         ///< folder for the thread at the start, in the hold, at the end; empty: none
  bool disturbances = false;  ///< note with each tick what disturbed it
};

struct PullResult {
  knot::KnotResult begun, left;
  int guard = 0;
  double pull_d = 0.0, hold_d = 0.0, after_d = 0.0;           ///< worst penetration, diameters
  double pull_lost = 0.0, hold_lost = 0.0, after_lost = 0.0;  ///< share of the time in which the thread stood still
  double strain = 0.0, tension_N = 0.0;                       ///< in the hold
  double turn_rad = 0.0, segment_d = 0.0;  ///< sharpest turn and longest segment in contact, in the hold
  double chatter = 0.0, sliding = 0.0;     ///< chatter.hpp: in the hold; while pulled
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
  /// until_N > 0: ends when pulled that hard; < 0: when eased below -until_N.
  void phase(double seconds, double speed, int hands, double until_N);
  void tick();
  /// The share of the time lost since it was asked last.
  [[nodiscard]] double lost();
  /// Largest turn at a node in contact, rad, and longest segment in contact, diameters.
  [[nodiscard]] std::pair<double, double> sharpness() const;

  scene::Scene scene_;
  physics::rod::RodSimulation sim_;
  PullOptions options_;
  std::array<physics::ToolInput, 2> tools_{};
  std::vector<Tick> ticks_;
  std::vector<double> forces_;
  double penetration_ = 0.0, lost_ = 0.0;
  std::size_t lost_from_ = 0;  // ticks before those in lost_
  int guard_ = 0;
};

}  // namespace ligature::bench
