#pragma once
#include <span>
#include <string>

#include "host/console/progress.hpp"
#include "host/export.hpp"
#include "host/export_sink.hpp"
#include "host/rig_facts.hpp"

namespace ligature::host {

/// Reads an LCM log (front to back in constant memory) or a flight recorder file (ticks only, no shapes) and passes its
/// content to `sinks`; the caller commits them. Each tick number of a session comes once, in order (TickOrder).
/// @param facts     what read_rig_facts() returned for this file.  @param progress  display of the position in a log;
/// may be null.
/// @throws BadInput when the file is of neither kind or holds no tick; RunFailed on a stop signal.
ExportResult read_recording(const std::string& path, const RigFacts& facts, std::span<ExportSink* const> sinks,
                            console::Progress* progress = nullptr);

}  // namespace ligature::host
