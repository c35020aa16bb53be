#pragma once
#include <stdexcept>

namespace ligature::host {

/// The user's request or input file is wrong. One line: file, place, what was found, what is allowed. Exit code 2.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The request was valid but could not be carried out: full disk, no network, or the rig refused. Exit code 3.
struct RunFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace ligature::host
