#include "protocol/scene/polyline.hpp"

#include <cmath>

#include "protocol/scene/csv.hpp"

namespace ligature::scene {
namespace {

constexpr double kFarthestPoint_m = 1e6;  // largest coordinate, m; squares of such values stay finite

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec plus(const Vec& a, double s, const Vec& b) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Direction of the last segment with non-zero length; straight down if there is none.
Vec end_direction(std::span<const Vec> points) {
  for (std::size_t k = points.size() - 1; k > 0; --k) {
    const Vec d = minus(points[k], points[k - 1]);
    const double length = std::sqrt(dot(d, d));
    if (length > 0.0) return {d[0] / length, d[1] / length, d[2] / length};
  }
  return {0.0, 0.0, -1.0};
}

}  // namespace

std::variant<std::vector<Vec>, Error> load_polyline(const std::filesystem::path& path) {
  auto read = read_csv(path, "x,y,z");
  if (auto* error = std::get_if<Error>(&read)) return *error;
  std::vector<Vec> points;
  for (const auto& row : std::get<std::vector<CsvRow>>(read)) {
    Vec p{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!parse_number(row.cells[i], p[i])) {
        return at_line(path, row.line, "found '" + shown(row.cells[i]) + "', allowed a finite number");
      }
      if (std::abs(p[i]) > kFarthestPoint_m)
        return at_line(path, row.line, "found " + shown(row.cells[i]) + ", allowed -1e6 .. 1e6");
    }
    points.push_back(p);
  }
  if (points.size() < 2) return Error{path.string() + ": found 1 point, allowed 2 or more"};
  return points;
}

std::vector<Vec> lay_out(std::span<const Vec> points, int n, double rest_m) {
  std::vector<Vec> nodes{points.front()};
  std::size_t k = 1;  // the next node is searched on segment points[k - 1] .. points[k]
  double from = 0.0;  // the search begins at this fraction 0 .. 1 of the segment
  const Vec onward = end_direction(points);
  while (nodes.size() < static_cast<std::size_t>(n)) {
    const Vec c = nodes.back();
    bool found = false;
    for (; k < points.size() && !found; ++k, from = 0.0) {
      // Intersection of the segment a + u d, 0 <= u <= 1, with the sphere of radius rest_m around the last node c. At
      // the larger root u the segment leaves the sphere.
      const Vec a = points[k - 1], d = minus(points[k], a), ac = minus(a, c);
      const double A = dot(d, d), B = dot(ac, d), C = dot(ac, ac) - rest_m * rest_m, D = B * B - A * C;
      if (A == 0.0 || D < 0.0) continue;
      const double u = (-B + std::sqrt(D)) / A;
      if (u < from || u > 1.0) continue;
      nodes.push_back(plus(a, u, d));
      from = u;
      found = true;
      break;
    }
    if (found) continue;
    // Beyond the polyline's end the chain continues straight along `onward`.
    const Vec ec = minus(points.back(), c);
    const double B = dot(ec, onward), C = dot(ec, ec) - rest_m * rest_m;
    const double s = C < 0.0 ? -B + std::sqrt(B * B - C) : 0.0;
    nodes.push_back(C < 0.0 ? plus(points.back(), s, onward) : plus(c, rest_m, onward));
  }
  return nodes;
}

}  // namespace ligature::scene
