#pragma once
// An initial shape for the thread, read from a CSV file with the header `x,y,z` (m).

#include <filesystem>
#include <span>
#include <variant>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// The points of the file. Refused, with file and line: a cell that is not a finite number; fewer than two points.
[[nodiscard]] std::variant<std::vector<Vec>, Error> load_polyline(const std::filesystem::path& path);

/// Lays a chain of n nodes with spacing rest_m along a polyline: every node lies on the polyline (or on its straight
/// continuation past the end) at the chord distance rest_m from the node before it, so no segment starts stretched.
/// @param points two or more, finite;  @param n >= 2;  @param rest_m > 0, m.  Cost O(points + n).
[[nodiscard]] std::vector<Vec> lay_out(std::span<const Vec> points, int n, double rest_m);

}  // namespace ligature::scene
