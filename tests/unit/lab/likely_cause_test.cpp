#include "host/lab/likely_cause.hpp"

#include <gtest/gtest.h>

namespace ligature::lab {
namespace {

TEST(LikelyCause, NamesTheTermThatOverstepsMost) {
  scene::Scene s;
  s.suture.paper.stretch_N = 1e9;
  EXPECT_NE(likely_cause(s).find("suture.stretch_N"), std::string::npos);
  s = {};
  s.hands.coupling_N_per_m = 1e9;
  EXPECT_NE(likely_cause(s).find("hands.coupling_N_per_m"), std::string::npos);
  s = {};
  s.suture.paper.bend = 1e9;
  EXPECT_NE(likely_cause(s).find("suture.bend is"), std::string::npos);
  s.suture.model = scene::Model::kPaper1;  // a model without bending
  EXPECT_EQ(likely_cause(s).find("suture.bend is"), std::string::npos);
}

TEST(LikelyCause, ADamperCountsOnlyWhenExplicit) {
  scene::Scene s;
  s.suture.paper.bend_damping = 1e6;
  EXPECT_EQ(likely_cause(s).find("bend_damping"), std::string::npos);
  s.suture.paper.damping = scene::Damping::kExplicit;
  EXPECT_NE(likely_cause(s).find("bend_damping"), std::string::npos);
}

TEST(LikelyCause, SaysSoWhenNoTermOversteps) {
  EXPECT_NE(likely_cause({}).find("no term oversteps"), std::string::npos);
}

TEST(LikelyCause, SpeaksOfTheRodWhenItIsOne) {
  scene::Scene s;
  s.suture.model = scene::Model::kRod;
  EXPECT_NE(likely_cause(s).find("the rod is stepped implicitly"), std::string::npos);
}

}  // namespace
}  // namespace ligature::lab
