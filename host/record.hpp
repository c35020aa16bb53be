#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/lcm_link.hpp"

namespace ligature::host {

struct RecordOptions {
  std::string out;
  std::string lcm_url{lcm_tools::kDefaultUrl};
  double duration_s = 0.0;  // 0: until a signal comes
  // folders whose flight recorder files may be read; empty: the default ones
  std::vector<std::filesystem::path> flight_folders{};
  bool force = false;  // may replace an existing file, with the first message
  bool quiet = false;  // no progress display
};

/// Records all messages on the rig's channels until the duration is over or a signal comes; then prints what was
/// recorded and what was lost. It continues when the firmware stops: a restarted firmware is recorded as a further
/// session.
/// @throws BadInput, RunFailed (disk, network, or no message at all).
void record(const RecordOptions& options);

}  // namespace ligature::host
