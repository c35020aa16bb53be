#pragma once
// Least squares: the material that explains a lab's measurements best.

#include <optional>
#include <string>
#include <vector>

#include "host/lab/fit/measurement.hpp"

namespace ligature::fit {

struct Estimate {
  double value = 0.0;
  double half_95 = 0.0;  ///< half the width of the 95 % interval
};
/// rms deviation of a measurement's rows from the fitted law, in the unit of the number that the law predicts.
struct Misfit {
  const Law* law;
  const char* figure;
  double rms;
  std::size_t rows;
};
struct Fitted {
  std::array<std::optional<Estimate>, kParameters> found;  ///< absent: no measurement tells
  std::vector<Misfit> misfits;
};

/// Fits by Levenberg-Marquardt in the logarithms of the parameters. Each kind of figure is weighted by its own scatter.
/// @pre check_enough(all)  @throws lab::Refusal (exit code 3) when the fit does not converge.
[[nodiscard]] Fitted fit(const std::vector<Measurement>& all);

/// Digits with which a value is printed and written.
inline constexpr int kDigits = 5;

/// Removes the values that no scene takes, and those of which the rows do not even tell the order of magnitude:
/// readings that contradict a law let its parameters run away. @return one line for each, with what was found and what
/// is allowed.
[[nodiscard]] std::vector<std::string> leave_out_impossible(Fitted& fitted);

}  // namespace ligature::fit
