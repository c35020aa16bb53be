#pragma once

#include <optional>

#include "firmware/app/admission.hpp"
#include "firmware/app/options.hpp"
#include "firmware/app/rig_setup.hpp"

namespace ligature::app {

/// `admit`: measures, prints the table. @return the exit code: 0 fits, 2 bad scene, 3 does not fit.
[[nodiscard]] int admit_scene(const AdmitOptions& options);

/// `run`'s short admission. @return why the scene must not run, with the largest nodes that would fit; nothing when it
/// fits.
[[nodiscard]] std::optional<Refusal> objection_of(const Admission& admission, const scene::Scene& scene, int core);

}  // namespace ligature::app
