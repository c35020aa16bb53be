#pragma once
#include <string>

#include "host/rig_facts.hpp"

namespace ligature::host {

/// What a CSV table cannot say of itself: "CSV on the Web" metadata (W3C, tabular-metadata) with the name, unit and
/// meaning of each column of `header`, beside the scene's text and the versions. It belongs into TABLE-metadata.json.
[[nodiscard]] std::string csv_metadata(const std::string& table_path, const std::string& header, const RigFacts& facts,
                                       const std::string& source);

}  // namespace ligature::host
