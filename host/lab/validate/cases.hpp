#pragma once
// The validation cases: what each checks, for which models, and its experiment.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::validate {

/// The model and resolution that a case examines.
struct Subject {
  scene::Model model = scene::Model::kRod;
  int nodes = 50;
  std::optional<scene::Accuracy> accuracy{};  ///< accuracy of the rod; absent: balanced, or what the case needs
  long work_instructions = 0;                 ///< budget of the rod's contacts in a tick; 0: by the accuracy
};

/// One measured number and its reference. `error` has the unit of `tolerance`.
struct Finding {
  std::string what;  ///< conditions and quantity, with the unit or scale of reference and measured value
  double reference = 0.0, measured = 0.0;
  double error = 0.0, tolerance = 0.0;
  std::string unit;  ///< unit of error and tolerance: "of L", "relative", "deg", ..
  [[nodiscard]] bool holds() const noexcept { return error <= tolerance; }  // false for NaN
};
using Findings = std::vector<Finding>;

/// |measured - reference|, in the tolerance's unit.
[[nodiscard]] Finding absolute(std::string what, double reference, double measured, double tolerance, std::string unit);
/// |measured / reference - 1|.
[[nodiscard]] Finding relative(std::string what, double reference, double measured, double tolerance);
/// least <= measured <= most; the error is the distance from this range.
[[nodiscard]] Finding within(std::string what, double least, double most, double measured);

struct Case {
  const char* name;
  const char* about;  ///< the reference, in a few words
  bool (*is_modelled)(scene::Model);
  Findings (*examine)(const Subject&);
  int only_nodes;  ///< 0: any number of nodes; else the number that the experiment needs
  bool quick;      ///< short enough for the unit tests
};

/// All validation cases, in the order of the printed table.
[[nodiscard]] std::span<const Case> all_cases();
/// nullptr when no case has that name.
[[nodiscard]] const Case* find_case(const std::string& name);

// The experiments, sorted by the file that defines them.
Findings elastica_tip_load(const Subject&);  // elastica.cpp
Findings elastica_heavy(const Subject&);
Findings catenary(const Subject&);  // strings.cpp
Findings elastic_string(const Subject&);
Findings hanging_chain(const Subject&);  // vibration.cpp
Findings cantilever_frequencies(const Subject&);
Findings cantilever_damping(const Subject&);
Findings clamped_twist(const Subject&);  // twist.cpp
Findings michell_ring(const Subject&);
Findings localised_helix(const Subject&);    // helix.cpp
Findings capstan_polygonal(const Subject&);  // capstan.cpp
Findings capstan_exponential(const Subject&);
Findings incline_threshold(const Subject&);  // friction.cpp
Findings stopping_distance(const Subject&);
Findings stick_creep(const Subject&);
Findings crossing_threads(const Subject&);  // contact.cpp
Findings heavy_rod_lifted(const Subject&);
Findings loose_overhand(const Subject&);  // overhand.cpp
Findings overhand_hysteresis(const Subject&);
Findings tight_trefoil(const Subject&);        // trefoil.cpp
Findings paper_static_shapes(const Subject&);  // paper_shapes.cpp
Findings paper_knots(const Subject&);

}  // namespace ligature::validate
