#pragma once
#include <memory>
#include <string>

#include "host/export_sink.hpp"

namespace ligature::host {

/// One HDF5 file of a recording; its layout is docs/analysis.md. @param source name of the recording, for the file.
/// @throws BadInput when it cannot be made.
[[nodiscard]] std::unique_ptr<ExportSink> make_hdf5_sink(const std::string& path, const RigFacts& facts,
                                                         const std::string& source);

}  // namespace ligature::host
