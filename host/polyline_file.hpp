#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ligature::host {

/// A centreline read from a file; points in metres, in order along the thread.
struct Polyline {
  std::vector<std::array<double, 3>> points;
  std::optional<double> time_s;  // of a shape out of many
  double radius_m = 0.0;         // of a recorded thread
  bool last_is_cut_off = false;  // the file's last shape lacks nodes and was not considered
};

/// Reads a CSV with `#` comments: columns x,y,z or x_m,y_m,z_m in any order among others, or three numbers a row
/// without header. With a column t_s (or time) it holds many shapes: the last one, or the one nearest to `at_s`.
/// A column `node` must then rise by one from 0 within a shape; a last shape with fewer nodes than the one before is
/// left out. A pipe is read too, up to 64 MB. @throws BadInput with the line number of what is wrong.
[[nodiscard]] Polyline read_polyline_csv(const std::string& path, std::optional<double> at_s);

/// The last LIGATURE_THREAD of a log, or the one nearest to `at_s`. @throws BadInput when there is none.
[[nodiscard]] Polyline read_polyline_log(const std::string& path, std::optional<double> at_s);

/// Whether a file begins like an LCM log.
[[nodiscard]] bool is_lcm_log(const std::string& path);

}  // namespace ligature::host
