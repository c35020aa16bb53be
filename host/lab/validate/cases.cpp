#include "host/lab/validate/cases.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::validate {
namespace {

using scene::Model;

bool every(Model) { return true; }
bool rod(Model m) { return m == Model::kRod; }
bool bends(Model m) { return m != Model::kPaper1; }
bool hookean(Model m) { return m != Model::kPaper5; }  // model 5 has a quadratic law of stretch

constexpr Case kCases[] = {
    {"elastica-tip", "elliptic integrals, PL2/EI 0.1 .. 10", bends, elastica_tip_load, 0, true},
    {"elastica-heavy", "shooting, wL3/EI 0.1 .. 10", bends, elastica_heavy, 0, true},
    {"catenary", "closed form, sag and end tension", every, catenary, 0, true},
    {"elastic-string", "closed form, hung with and without a weight", hookean, elastic_string, 0, true},
    {"hanging-chain", "N equal masses: zeros of Laguerre polynomials", every, hanging_chain, 0, true},
    {"cantilever", "Euler-Bernoulli f1, f2, f3", bends, cantilever_frequencies, 0, true},
    {"cantilever-damping", "what the steps damp of modes 1-3; bar: mode 1 at fine", rod, cantilever_damping, 154,
     false},
    {"clamped-twist", "tan(x/2) = x/2", rod, clamped_twist, 0, true},
    {"michell-ring", "sqrt(3) B/C turns", rod, michell_ring, 0, true},
    {"localised-helix", "infinite twisted rod", rod, localised_helix, 0, true},
    {"capstan-polygonal", "32 or 64 contact segments", rod, capstan_polygonal, 0, true},
    {"capstan", "exp(mu theta)", rod, capstan_exponential, 0, false},
    {"incline", "atan(mu)", every, incline_threshold, 0, true},
    {"stopping-distance", "v^2 / 2 mu g", every, stopping_distance, 0, true},
    {"stick-creep", "half a degree below the threshold", every, stick_creep, 0, false},
    {"crossing-threads", "two Hookean strands in balance", hookean, crossing_threads, 0, true},
    {"heavy-rod-lifted", "nonlinear boundary value problem", bends, heavy_rod_lifted, 0, true},
    {"loose-overhand", "elastic knot without friction, to first order", rod, loose_overhand, 0, true},
    {"overhand-hysteresis", "elastic knot tightened and loosened", rod, overhand_hysteresis, 0, false},
    {"tight-trefoil", "ideal closed trefoil 16.37", rod, tight_trefoil, 50, true},
    {"paper-shapes", "rod with Table I against paper-4 at rest", rod, paper_static_shapes, 50, true},
    {"paper-knots", "rod with Table I, the operators' scripts", rod, paper_knots, 50, false},
};

}  // namespace

Finding absolute(std::string what, double reference, double measured, double tolerance, std::string unit) {
  return {std::move(what), reference, measured, std::abs(measured - reference), tolerance, std::move(unit)};
}

Finding relative(std::string what, double reference, double measured, double tolerance) {
  return {std::move(what), reference, measured, std::abs(measured / reference - 1.0), tolerance, "relative"};
}

Finding within(std::string what, double least, double most, double measured) {
  const double outside = measured < least ? least - measured : measured > most ? measured - most : 0.0;
  return {std::move(what), least, measured, std::isnan(measured) ? measured : outside, 0.0, "outside"};
}

std::span<const Case> all_cases() { return kCases; }

const Case* find_case(const std::string& name) {
  const auto found = std::find_if(std::begin(kCases), std::end(kCases), [&](const Case& c) { return name == c.name; });
  return found == std::end(kCases) ? nullptr : found;
}

}  // namespace ligature::validate
