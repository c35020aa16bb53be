#pragma once
#include <cstdio>
#include <string>

namespace ligature::host {

/// Says on stderr what is damaged in a log (LogReader::damage()); says nothing of an intact one.
inline void tell_damage(const std::string& log_path, const std::string& damage) {
  if (!damage.empty()) std::fprintf(stderr, "ligature-host: %s: %s\n", log_path.c_str(), damage.c_str());
}

}  // namespace ligature::host
