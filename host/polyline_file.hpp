#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ligature::host {

/// A centreline read from a file; points in m, in order along the thread.
struct Polyline {
  std::vector<std::array<double, 3>> points;
  std::optional<double> time_s;  // time of the shape, when the file has several
  double radius_m = 0.0;         // radius of the recorded thread, m; 0 when unknown
  bool last_is_cut_off = false;  // the file's last shape is incomplete and was ignored
  std::string damage{};          // of a log: one line about its damaged parts; empty when it is intact
};

/// Reads a CSV file with `#` comments: columns x,y,z or x_m,y_m,z_m in any order, other columns allowed; or without a
/// header three numbers a row, or four of which the first numbers the row. A header that has one of the columns twice
/// is refused. With a column t_s (or time) the file holds several shapes; the last one is returned, or the one nearest
/// to `at_s`. Then the column `node` must rise by one from 0 within a shape, and a last shape with fewer nodes than the
/// one before is ignored. Pipes are read up to 64 MB. @throws BadInput with the line number of the error.
[[nodiscard]] Polyline read_polyline_csv(const std::string& path, std::optional<double> at_s);

/// Reads the last LIGATURE_THREAD message of a log, or the one nearest to `at_s`. @throws BadInput when there is none.
[[nodiscard]] Polyline read_polyline_log(const std::string& path, std::optional<double> at_s);

/// Whether the file starts like an LCM log.
[[nodiscard]] bool is_lcm_log(const std::string& path);

}  // namespace ligature::host
