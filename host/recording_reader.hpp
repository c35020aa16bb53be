#pragma once
#include <span>
#include <string>

#include "host/console/progress.hpp"
#include "host/export.hpp"
#include "host/export_sink.hpp"
#include "host/rig_facts.hpp"

namespace ligature::host {

/// Reads an LCM log (front to back in constant memory) or a flight recorder file (which holds ticks and no shapes) into
/// sinks that are not committed yet. Each tick number of a session comes once, in order (TickOrder).
/// @param facts     of that file (read_rig_facts).  @param progress  is shown how far a log is; may be null.
/// @throws BadInput for a file that is neither or holds no tick; RunFailed for a stop request.
ExportResult read_recording(const std::string& path, const RigFacts& facts, std::span<ExportSink* const> sinks,
                            console::Progress* progress = nullptr);

}  // namespace ligature::host
