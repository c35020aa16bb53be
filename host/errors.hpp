#pragma once
#include <stdexcept>

namespace ligature::host {

/// What was asked or read is wrong: one line with file, place, what was found, what is allowed. Exit code 2.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The request was sound, doing it failed: full disk, no network, a refusal of the rig. Exit code 3.
struct RunFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace ligature::host
