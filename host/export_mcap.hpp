#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// One MCAP file of a recording, for Foxglove, PlotJuggler and the like; its topics are in docs/analysis.md. Written
/// by the `mcap` package of the Python that scripts/setup made. @throws BadInput when there is none.
[[nodiscard]] std::unique_ptr<ExportSink> make_mcap_sink(const std::string& path, const RigFacts& facts,
                                                         const std::string& source);

}  // namespace ligature::host
