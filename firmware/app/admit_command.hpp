#pragma once

#include <optional>

#include "firmware/app/admission.hpp"
#include "firmware/app/options.hpp"
#include "firmware/app/rig_setup.hpp"

namespace ligature::app {

/// `admit`: measures, prints the table. @return the exit code: 0 fits, 2 bad scene, 3 does not fit.
[[nodiscard]] int admit_scene(const AdmitOptions& options);

/// Why a scene so admitted must not run, with what would fit, searched for by `measure`; nothing when it fits.
[[nodiscard]] std::optional<Refusal> objection_of(const Admission& admission, const scene::Scene& scene,
                                                  const Measure& measure);

}  // namespace ligature::app
