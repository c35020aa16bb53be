#include "host/knot/common_name.hpp"

namespace ligature::knot {

std::string common_name(const std::string& type, const std::string& handedness) {
  if (type == "3_1") return "overhand";
  if (type == "4_1") return "figure-eight";
  if (type == "3_1#3_1") return handedness == "amphichiral" ? "square" : "granny";
  if (type == "3_1#5_1" && handedness == "mixed") return "surgeon's";
  return "";
}

std::string full_name(const std::string& type, const std::string& handedness) {
  std::string words = type;
  if (handedness != "none") words += " " + handedness;
  if (const auto common = common_name(type, handedness); !common.empty()) words += ", " + common;
  return words;
}

}  // namespace ligature::knot
