#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// Where to write tables; an empty name is not written.
struct CsvTargets {
  std::string forces, shape, ticks;
};

/// CSV tables, and beside each TABLE-metadata.json (csv_metadata.hpp).
[[nodiscard]] std::unique_ptr<ExportSink> make_csv_sink(const CsvTargets& targets, const RigFacts& facts,
                                                        const std::string& source);

}  // namespace ligature::host
