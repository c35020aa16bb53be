#include "host/lab/trace_row.hpp"

#include <algorithm>
#include <sstream>

#include "host/lab/likely_cause.hpp"

namespace ligature::lab {

TraceRow row_of(const physics::Simulation& simulation, const scene::Scene& scene, double t_s, double step_us) {
  const auto& d = simulation.diagnostics();
  return {t_s,
          simulation.hand(physics::Hand::kLeft).f_W,
          simulation.hand(physics::Hand::kRight).f_W,
          d.kinetic_J,
          d.potential_J,
          d.max_stretch,
          std::min(d.min_gap_m, scene.suture.length_m),
          d.contacts,
          step_us};
}

std::string divergence(const physics::Diagnostics& d, const scene::Scene& scene, std::int64_t tick, double t_s) {
  std::ostringstream text;
  text << "diverged at tick " << (d.bad_tick >= 0 ? d.bad_tick : tick) << " (t = " << t_s << " s), ";
  if (!d.finite && d.bad_node < 0)  // the hand's input was invalid; the thread is unaffected
    text << "by a hand whose position or speed is no number, or beyond 1e9";
  else
    text << "node " << d.bad_node << "; likely cause: " << likely_cause(scene);
  return text.str();
}

}  // namespace ligature::lab
