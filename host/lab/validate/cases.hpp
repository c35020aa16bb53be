#pragma once
// Every case of the validation: what it checks, on which models, and the experiment itself.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::validate {

/// Whom a case examines.
struct Subject {
  scene::Model model = scene::Model::kRod;
  int nodes = 50;
  std::optional<scene::Accuracy> accuracy{};  ///< of the rod; absent: balanced, but as a case needs it
};

/// One number against its reference. The error is in the unit of the tolerance.
struct Finding {
  std::string what;  ///< conditions and quantity, with the unit or scale of reference and measured
  double reference = 0.0, measured = 0.0;
  double error = 0.0, tolerance = 0.0;
  std::string unit;  ///< of error and tolerance: "of L", "relative", "deg", ..
  [[nodiscard]] bool holds() const noexcept { return error <= tolerance; }  // false for NaN
};
using Findings = std::vector<Finding>;

/// |measured - reference|, in the tolerance's unit.
[[nodiscard]] Finding absolute(std::string what, double reference, double measured, double tolerance, std::string unit);
/// |measured / reference - 1|.
[[nodiscard]] Finding relative(std::string what, double reference, double measured, double tolerance);
/// least <= measured <= most; the error is how far outside.
[[nodiscard]] Finding within(std::string what, double least, double most, double measured);

struct Case {
  const char* name;
  const char* about;  ///< reference, in a few words
  bool (*is_modelled)(scene::Model);
  Findings (*examine)(const Subject&);
  int only_nodes;  ///< 0: at whatever is asked for; else the experiment has its own number of nodes
  bool quick;      ///< takes a moment: the tests run it
};

/// In the order of the printed table.
[[nodiscard]] std::span<const Case> all_cases();
/// nullptr when there is none of that name.
[[nodiscard]] const Case* find_case(const std::string& name);

// The experiments, by file.
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
