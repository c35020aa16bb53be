#include "protocol/scene/polyline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/temp_folder.hpp"

namespace ligature::scene {
namespace {

double distance(const Vec& a, const Vec& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

TEST(LayOut, EverySegmentHasTheRestLength) {
  std::vector<Vec> helix;
  for (int k = 0; k < 200; ++k) helix.push_back({std::cos(0.1 * k), std::sin(0.1 * k), 0.02 * k});
  // Node spacings below and above the spacing of the polyline's points. With 0.37 and 3.0 m the nodes go on beyond the
  // polyline's end.
  for (const double rest_m : {0.01, 0.1, 0.37, 3.0}) {
    const auto nodes = lay_out(helix, 60, rest_m);
    ASSERT_EQ(nodes.size(), 60u);
    EXPECT_EQ(nodes[0], helix[0]);
    for (std::size_t k = 1; k < nodes.size(); ++k) EXPECT_NEAR(distance(nodes[k - 1], nodes[k]), rest_m, 1e-12);
  }
}

TEST(LayOut, ContinuesStraightPastTheEnd) {
  const auto nodes = lay_out(std::vector<Vec>{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}}, 5, 0.6);
  EXPECT_NEAR(nodes[4][2], 2.4, 1e-12);
}

TEST(LoadPolyline, RefusesByLine) {
  const auto path = test::temp_folder() + "shape.csv";
  std::ofstream(path) << "x,y,z\n0,0,0\n0,zero,0\n";
  EXPECT_NE(std::get<Error>(load_polyline(path)).text.find(":3: found 'zero'"), std::string::npos);
  std::ofstream(path) << "x,y,z\n0,0,0\n0,-1e300,0\n";
  EXPECT_NE(std::get<Error>(load_polyline(path)).text.find(":3: found -1e300, allowed -1e6 .. 1e6"), std::string::npos);
  std::ofstream(path) << "x,y,z\n0,0,0\n";
  EXPECT_NE(std::get<Error>(load_polyline(path)).text.find("found 1 point"), std::string::npos);
}

}  // namespace
}  // namespace ligature::scene
