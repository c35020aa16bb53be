#pragma once
#include <string>

#include "host/rig_facts.hpp"

namespace ligature::host {

/// The metadata file of a CSV table, in the format "CSV on the Web" (W3C, tabular-metadata): name, unit and meaning of
/// each column of `header`, the scene's text, the versions and the recording's notes. To be written to
/// TABLE-metadata.json.
[[nodiscard]] std::string csv_metadata(const std::string& table_path, const std::string& header, const RigFacts& facts,
                                       const std::string& source, const std::string& notes);

}  // namespace ligature::host
