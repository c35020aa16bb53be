#pragma once

#include "firmware/app/options.hpp"

namespace ligature::app {

/// The `admit` command: measures the scene's cost on this machine and prints it as a table. @return the exit code: 0
/// admitted, 2 bad scene, 3 refused.
[[nodiscard]] int admit_scene(const AdmitOptions& options);

}  // namespace ligature::app
