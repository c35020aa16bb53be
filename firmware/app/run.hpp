#pragma once

#include "firmware/app/options.hpp"

namespace ligature::app {

/// The whole life of the controller. @return the exit code: 0 done, 2 bad scene, 3 fault at the end or no start.
[[nodiscard]] int run(const RunOptions& options);

}  // namespace ligature::app
