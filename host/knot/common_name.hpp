#pragma once
#include <string>

namespace ligature::knot {

/// The name that surgeons and sailors use, e.g. "square" for 3_1#3_1 amphichiral; "" for a knot without one.
[[nodiscard]] std::string common_name(const std::string& type, const std::string& handedness);
/// Type, handedness and common name, e.g. "3_1#3_1 amphichiral, square".
[[nodiscard]] std::string full_name(const std::string& type, const std::string& handedness);

}  // namespace ligature::knot
