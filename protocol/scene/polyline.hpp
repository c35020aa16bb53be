#pragma once
// Start shape of the thread, from a CSV file with the header `x,y,z` (m).

#include <filesystem>
#include <span>
#include <variant>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// The points of the file. Refuses, with file and line: a cell that is not a finite number; fewer than two points.
[[nodiscard]] std::variant<std::vector<Vec>, Error> load_polyline(const std::filesystem::path& path);

/// Places n nodes with spacing rest_m along a polyline. Every node lies on the polyline (or its straight continuation
/// beyond the end) at the straight distance rest_m from the previous node, so that no segment is stretched.
/// @param points two or more, finite;  @param n >= 2;  @param rest_m > 0, m.  Cost O(points + n).
[[nodiscard]] std::vector<Vec> lay_out(std::span<const Vec> points, int n, double rest_m);

}  // namespace ligature::scene
