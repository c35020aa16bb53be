#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// Writes one MCAP file, for Foxglove, PlotJuggler and others; its topics are in docs/analysis.md. The `mcap` package
/// of the Python environment from scripts/setup writes it. @throws BadInput without that environment.
[[nodiscard]] std::unique_ptr<ExportSink> make_mcap_sink(const std::string& path, const RigFacts& facts,
                                                         const std::string& source);

}  // namespace ligature::host
