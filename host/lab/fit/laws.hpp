#pragma once
// The kinds of measurement that `ligature-lab fit` reads: each has a CSV header, and a law that predicts the measured
// values.

#include <span>
#include <string>
#include <vector>

#include "host/lab/fit/material.hpp"

namespace ligature::fit {

struct Column {
  const char* name;
  double least, most;  ///< allowed range; both bounds belong to it
};

/// One kind of measurement. A row gives `figures` numbers that the law predicts; the fit makes
/// residual = predicted - measured small for each.
struct Law {
  const char* name;
  const char* header;
  const char* recipe;
  std::vector<Column> columns;
  std::vector<Parameter> finds;  ///< parameters that it determines
  std::vector<Parameter> needs;  ///< parameters that another measurement must determine
  std::size_t least_rows;
  std::vector<const char*> figures;  ///< names of the residuals, with their scale
  /// Why a row is impossible, as "COLUMN: found X, allowed Y"; empty: it is possible.
  std::string (*refused)(std::span<const double> row);
  void (*residuals)(const Parameters& p, std::span<const double> row, std::span<double> out);
};

[[nodiscard]] const std::vector<Law>& laws();

}  // namespace ligature::fit
