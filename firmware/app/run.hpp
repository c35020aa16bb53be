#pragma once

#include "firmware/app/options.hpp"

namespace ligature::app {

/// The `run` command, from start to end. @return the exit code: 0 done, 2 bad scene, 3 start failed or ended in a
/// fault.
[[nodiscard]] int run(const RunOptions& options);

}  // namespace ligature::app
