#include "firmware/app/worst_case.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "protocol/scene/random.hpp"

namespace ligature::app {
namespace {

using physics::Vec3;

/// Corner points of one continuous path that is laid back and forth: rows along x, stacked in y, in layers along z.
std::vector<Vec3> corners(double length_m, double spacing_m) {
  const int rows = std::max(2, static_cast<int>(std::cbrt(length_m / spacing_m)));
  const double row_m = std::max(2.0 * spacing_m, rows * spacing_m);
  std::vector<Vec3> path;
  double wound_m = 0.0;
  for (int line = 0; wound_m < length_m; ++line) {
    const int layer = line / rows, in_layer = line % rows;
    const double y = spacing_m * (layer % 2 == 0 ? in_layer : rows - 1 - in_layer), z = spacing_m * layer;
    const bool forth = line % 2 == 0;
    path.emplace_back(forth ? 0.0 : row_m, y, z);
    path.emplace_back(forth ? row_m : 0.0, y, z);
    wound_m += row_m + spacing_m;
  }
  return path;
}

Vec3 normal_vector(std::mt19937& random) {
  const auto [x, y, z] = scene::normals(random);
  return {x, y, z};
}

}  // namespace

std::vector<Vec3> wound_up(int nodes, double l_rest_m, double spacing_m, const Vec3& centre_W_m) {
  const auto path = corners((nodes + 1) * l_rest_m, spacing_m);
  std::vector<Vec3> p_W;
  std::size_t piece = 0;
  double into_m = 0.0;  // distance of the next node from the start of this piece
  while (static_cast<int>(p_W.size()) < nodes) {
    const Vec3 along = path[piece + 1] - path[piece];
    const double piece_m = along.norm();
    if (into_m > piece_m && piece + 2 < path.size()) {
      into_m -= piece_m;
      ++piece;
      continue;
    }
    p_W.push_back(centre_W_m + path[piece] + (into_m / piece_m) * along);
    into_m += l_rest_m;
  }
  return p_W;
}

std::vector<Vec3> crumpled(int nodes, double l_rest_m, double ball_m, const Vec3& centre_W_m, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3> p_W;
  Vec3 at = Vec3::Zero(), along = Vec3::UnitX();
  for (int i = 0; i < nodes; ++i) {
    p_W.push_back(centre_W_m + at);
    along += 0.6 * normal_vector(random) - (0.6 * at.norm() / (ball_m * ball_m)) * at;
    along.normalize();
    at += l_rest_m * along;
  }
  return p_W;
}

std::vector<Shape> worst_shapes(const scene::Scene& scene) {
  const auto& s = scene.suture;
  const double l_rest_m = s.length_m / (s.nodes - 1), diameter_m = 2.0 * s.radius_m;
  const auto& fixed = scene.world.fixed;
  const Vec3 centre_W_m = fixed.empty() ? Vec3(0.0, 0.0, 1.0)
                                        : Vec3(fixed[0].position_m[0], fixed[0].position_m[1], fixed[0].position_m[2]);
  std::vector<Shape> shapes{{}};
  for (const double pressed : {1.5, 1.2, 1.05, 1.0, 0.9, 0.7, 0.5})
    shapes.push_back({wound_up(s.nodes, l_rest_m, pressed * diameter_m, centre_W_m), {}});
  unsigned seed = 1;
  for (const double ball_diameters : {6.0, 20.0}) {
    for (const double thrown_m_per_s : {0.0, 0.2, 1.0}) {
      Shape shape{crumpled(s.nodes, l_rest_m, ball_diameters * diameter_m, centre_W_m, ++seed), {}};
      std::mt19937 random(seed);
      for (int i = 0; i < s.nodes; ++i) shape.v_W.push_back(thrown_m_per_s / std::sqrt(3.0) * normal_vector(random));
      shapes.push_back(std::move(shape));
    }
  }
  return shapes;
}

}  // namespace ligature::app
