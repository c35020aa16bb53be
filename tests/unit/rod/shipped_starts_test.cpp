// In each shipped scene with a loose knot, the start shape that the rod's nodes form has the knot type of the scene's
// name.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "host/knot/recognise.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::test {
namespace {

using physics::rod::RodSimulation;

std::string folder() { return std::string(LIGATURE_SOURCE_DIR) + "/scenes/"; }

struct Shipped {
  const char *scene, *type, *handedness;
  bool bends_set = false;  // the scene enables plastic bending, in two additional lines
};

class ShippedStart : public testing::TestWithParam<Shipped> {};

std::vector<std::string> settings(const std::string& scene) {
  std::ifstream in(folder() + scene);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    const bool is_own =
        line.starts_with("initial") || line.starts_with("yield_strain") || line.starts_with("set_fraction");
    if (!line.starts_with('#') && !is_own) lines.push_back(line);
  }
  return lines;
}

TEST_P(ShippedStart, HasItsKnotAndIsLooseAndUnstretched) {
  const auto read = scene::load_scene(folder() + GetParam().scene);
  ASSERT_TRUE(std::holds_alternative<scene::Scene>(read)) << std::get<scene::Error>(read).text;
  const auto& scene = std::get<scene::Scene>(read);
  auto made = RodSimulation::make(scene);
  ASSERT_TRUE(std::holds_alternative<RodSimulation>(made));
  auto& sim = std::get<RodSimulation>(made);
  const auto& state = sim.rod().state();
  std::vector<std::array<double, 3>> points;
  double worst_strain = 0.0, nearest_m = 1.0;
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const auto& p = sim.nodes_W()[i];
    points.push_back({p.x(), p.y(), p.z()});
    if (i > 0)
      worst_strain = std::max(worst_strain, std::abs(norm(state.x[i] - state.x[i - 1]) / state.mesh.rest[i - 1] - 1.0));
    for (std::size_t k = 0; k < i; ++k) {
      if (state.mesh.s[i] - state.mesh.s[k] > 0.01) nearest_m = std::min(nearest_m, norm(state.x[i] - state.x[k]));
    }
  }
  const auto knot = knot::recognise(points, false);
  EXPECT_EQ(knot.type, GetParam().type);
  EXPECT_EQ(knot.handedness, GetParam().handedness);
  EXPECT_LT(worst_strain, 1e-9);
  EXPECT_GT(nearest_m, 4.0 * 2.0 * scene.suture.radius_m);
  EXPECT_EQ(scene.suture.rod.yield_strain.has_value(), GetParam().bends_set);
  EXPECT_EQ(settings(GetParam().scene), settings("suture-3-0-knot.toml"));  // no other setting differs
}

INSTANTIATE_TEST_SUITE_P(Knots, ShippedStart,
                         testing::Values(Shipped{"suture-3-0-knot.toml", "3_1", "left"},
                                         Shipped{"suture-3-0-figure-eight.toml", "4_1", "amphichiral", true},
                                         Shipped{"suture-3-0-square.toml", "3_1#3_1", "amphichiral"},
                                         Shipped{"suture-3-0-granny.toml", "3_1#3_1", "right"},
                                         Shipped{"suture-3-0-surgeons.toml", "3_1#5_1", "mixed"}));

}  // namespace
}  // namespace ligature::test
