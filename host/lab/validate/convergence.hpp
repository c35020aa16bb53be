#pragma once
// How fast the rod approaches the truth: order in N and in the number of substeps.

#include <string>
#include <vector>

namespace ligature::validate {

/// Errors of one quantity at resolutions that double.
struct Ladder {
  std::string what;                ///< quantity and what is refined
  std::vector<double> resolution;  ///< nodes, or substeps
  std::vector<double> error;
  /// Least-squares slope of -log(error) over log(resolution).
  [[nodiscard]] double order() const;
};

/// Elastica, hanging chain and localised helix, each in N and in substeps.
[[nodiscard]] std::vector<Ladder> convergence();

}  // namespace ligature::validate
