#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/lcm_link.hpp"

namespace ligature::host {

struct RecordOptions {
  std::string out;
  std::string lcm_url{kDefaultLcmUrl};
  double duration_s = 0.0;                              // 0: until a signal
  std::vector<std::filesystem::path> flight_folders{};  // whose flight recorders may be read; empty: the usual ones
  bool force = false;                                   // replace an existing file
  bool quiet = false;                                   // no progress
};

/// Writes every message of the rig's channels to a log until the time is over or a signal comes, then says what was
/// recorded and what was lost. The recorder does not end when the firmware does: a restarted firmware is recorded
/// as a further session.
/// @throws BadInput, RunFailed (disk, network, or nothing at all came).
void record(const RecordOptions& options);

}  // namespace ligature::host
