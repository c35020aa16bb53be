#pragma once
#include <limits>
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

struct TraceTarget {
  std::string path;  // empty: not written
  double from_s = 0.0, to_s = std::numeric_limits<double>::infinity();
};

/// Writes when each phase of each tick ran, as a trace for ui.perfetto.dev (Chrome's Trace Event Format, JSON).
/// Its tracks are in docs/analysis.md. @throws BadInput when the file cannot be created; the sink's check() throws it
/// when the span has no tick.
[[nodiscard]] std::unique_ptr<ExportSink> make_trace_sink(const TraceTarget& target, const RigFacts& facts,
                                                          const std::string& source);

}  // namespace ligature::host
