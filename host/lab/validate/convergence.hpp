#pragma once
// Order of convergence of the rod in the number of nodes and of substeps.

#include <string>
#include <vector>

namespace ligature::validate {

/// Errors of one quantity at successively doubled resolutions.
struct Ladder {
  std::string what;                ///< the quantity, and what is refined
  std::vector<double> resolution;  ///< nodes, or substeps
  std::vector<double> error;
  /// Observed order: least-squares slope of -log(error) over log(resolution).
  [[nodiscard]] double order() const;
};

/// Convergence studies of elastica, hanging chain and localised helix, each in nodes and in substeps.
[[nodiscard]] std::vector<Ladder> convergence();

}  // namespace ligature::validate
