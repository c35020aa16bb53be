#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// Writes one HDF5 file; its layout is in docs/analysis.md. @param source name of the recording, stored in the file.
/// @throws BadInput when the file cannot be created.
[[nodiscard]] std::unique_ptr<ExportSink> make_hdf5_sink(const std::string& path, const RigFacts& facts,
                                                         const std::string& source);

}  // namespace ligature::host
