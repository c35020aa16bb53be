#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// Names of the tables to write; an empty one is not written.
struct CsvTargets {
  std::string forces, shape, ticks;
};

/// Writes CSV tables, and TABLE-metadata.json beside each (csv_metadata.hpp).
[[nodiscard]] std::unique_ptr<ExportSink> make_csv_sink(const CsvTargets& targets, const RigFacts& facts,
                                                        const std::string& source);

}  // namespace ligature::host
