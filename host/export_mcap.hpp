#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// Writes one MCAP file, for Foxglove, PlotJuggler and others; its topics are in docs/analysis.md. Messages are in the
/// order of the recording. @throws BadInput when the file cannot be created.
[[nodiscard]] std::unique_ptr<ExportSink> make_mcap_sink(const std::string& path, const RigFacts& facts,
                                                         const std::string& source);

}  // namespace ligature::host
