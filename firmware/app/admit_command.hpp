#pragma once

#include "firmware/app/options.hpp"

namespace ligature::app {

/// The `admit` command: measures and prints the table. @return the exit code: 0 admitted, 2 bad scene, 3 refused.
[[nodiscard]] int admit_scene(const AdmitOptions& options);

}  // namespace ligature::app
