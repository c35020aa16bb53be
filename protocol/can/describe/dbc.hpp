#pragma once
// DBC of one hand's bus, written from the PDO table: for cantools, SavvyCAN and the like.

#include <string>

namespace ligature::can {

[[nodiscard]] std::string dbc_text();

/// Name of a node in the DBC: Waist, Shoulder, Elbow.
[[nodiscard]] const char* node_name(unsigned node_id) noexcept;

}  // namespace ligature::can
