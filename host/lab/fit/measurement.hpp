#pragma once
// A lab's measurement, read from a CSV file.

#include <filesystem>
#include <string>
#include <vector>

#include "host/lab/fit/laws.hpp"

namespace ligature::fit {

struct Measurement {
  const Law* law = nullptr;
  std::string file;
  std::vector<std::vector<double>> rows;
};

/// Reads a file; its header says which law it belongs to. @throws lab::Refusal with one line.
[[nodiscard]] Measurement read_measurement(const std::filesystem::path& path);

/// Checks that all measurements together suffice to determine the parameters that they depend on. @throws lab::Refusal
/// with one line.
void check_enough(const std::vector<Measurement>& all);

}  // namespace ligature::fit
