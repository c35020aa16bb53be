#pragma once
#include <optional>
#include <string>

namespace ligature::host {

struct KnotOptions {
  std::string file{};            // CSV polyline or LCM log
  bool closed = false;           // --closed: the last point joins the first
  bool open = false;             // --open: the last point does not join the first, even where the two coincide
  std::optional<double> at_s{};  // time of the shape in a log with many; without it the last shape
  bool json = false;
};

/// Names the knot of a file. @return the line to print.
/// Without --closed and --open, a polyline counts as closed when its last point repeats its first. @throws BadInput.
[[nodiscard]] std::string describe_knot(const KnotOptions& options);

}  // namespace ligature::host
