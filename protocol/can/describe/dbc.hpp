#pragma once
// DBC file of one hand's bus, generated from the PDO table; for tools such as cantools and SavvyCAN.

#include <string>

namespace ligature::can {

[[nodiscard]] std::string dbc_text();

/// Name of a node in the DBC: Waist, Shoulder, Elbow.
[[nodiscard]] const char* node_name(unsigned node_id) noexcept;

}  // namespace ligature::can
