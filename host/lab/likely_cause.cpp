#include "host/lab/likely_cause.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

namespace ligature::lab {
namespace {

struct Limit {
  const char* what;
  double largest_dt_s;
};

/// x: a term's largest stable time step. It is not finite when the scene lacks that term; then a huge step is returned.
double or_never(double x) { return std::isfinite(x) ? x : 1e300; }

std::vector<Limit> limits(const scene::Scene& s) {
  const auto& p = s.suture.paper;
  const double m = p.node_mass_kg, l = s.suture.length_m / (s.suture.nodes - 1);
  std::vector<Limit> all{
      {"suture.stretch_N is too stiff", or_never(std::sqrt(m * l / p.stretch_N))},
      {"hands.coupling_N_per_m is too stiff", or_never(2.0 * std::sqrt(m / s.hands.coupling_N_per_m))},
      {"hands.coupling_N_s_per_m is too large", or_never(2.0 * m / s.hands.coupling_N_s_per_m)},
  };
  if (s.suture.model != scene::Model::kPaper1) {
    all.push_back({"suture.bend is too stiff", or_never(l * std::sqrt(std::numbers::pi * m / (4.0 * p.bend)))});
  }
  if (p.damping == scene::Damping::kExplicit) {
    all.push_back({"suture.stretch_damping is too large", or_never(m / (2.0 * p.stretch_damping))});
    all.push_back({"suture.bend_damping is too large", or_never(m * l * l / (8.0 * p.bend_damping))});
  }
  if (p.integrator == scene::Integrator::kForward) {
    all.push_back({"suture.integrator = \"forward\" gains energy", or_never(p.stretch_damping * l / p.stretch_N)});
  }
  return all;
}

}  // namespace

std::string likely_cause(const scene::Scene& s) {
  const double dt_s = s.time.tick_s / s.time.substeps;
  if (s.suture.model == scene::Model::kRod) {
    std::ostringstream rod;
    rod.precision(2);
    rod << "the rod is stepped implicitly, so rather a hand that jumps, a thread that moves more than its radius in a "
           "step of "
        << dt_s << " s, or a start that overlaps itself: shorten time.tick_s, or look at the last rows of trace.csv";
    return rod.str();
  }
  const auto all = limits(s);
  const auto worst = std::min_element(all.begin(), all.end(),
                                      [](const Limit& a, const Limit& b) { return a.largest_dt_s < b.largest_dt_s; });
  std::ostringstream text;
  text.precision(2);
  if (dt_s > worst->largest_dt_s) {
    text << worst->what << " for a step of " << dt_s << " s (stable below about " << worst->largest_dt_s
         << " s): shorten time.tick_s or raise time.substeps";
  } else {
    text << "no term oversteps its own limit at a step of " << dt_s
         << " s: a hand that jumps, a force out of scale, or a start with coincident nodes; look at the last rows of "
            "trace.csv";
  }
  return text.str();
}

}  // namespace ligature::lab
