// The two scenes of the paper, one with its equations as printed and one with our corrections, and the combinations of
// forces of its section III.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "ligature_source_dir.hpp"
#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

using test::knot_of;
using test::make;
using test::overhand;
using test::paper_scene;
using test::play;

scene::Scene shipped(const std::string& name, const std::vector<std::string>& overrides = {}) {
  auto loaded = scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/" + name, overrides);
  if (auto* error = std::get_if<scene::Error>(&loaded)) throw std::runtime_error(error->text);
  return std::get<scene::Scene>(loaded);
}

TEST(AsInThePaper, CorrectedTiesAnOverhandWithinTheLengthLimitsAndTellsTheConditions) {
  const auto scene = shipped("paper-corrected.toml");
  EXPECT_EQ(scene.contact.friction, 10.0);
  EXPECT_TRUE(scene.hands.propagation);
  Simulation sim = make(scene);
  std::set<Propagation> seen;
  double least = 0.0, most = 0.0;
  const auto script = overhand();
  std::string at_ten_seconds;
  for (int k = 0; k < 24'000; ++k) {
    play(sim, script, 1e-3 * k, 1e-3 * (k + 1));
    if (k == 10'000) at_ten_seconds = knot_of(sim).type;
    for (const auto hand : {Hand::kLeft, Hand::kRight}) seen.insert(sim.hand(hand).condition);
    const auto p = sim.nodes_W();
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      const double strain = (p[i + 1] - p[i]).norm() / (5.0 / 49.0) - 1.0;
      least = std::min(least, strain), most = std::max(most, strain);
    }
  }
  EXPECT_EQ(at_ten_seconds, "3_1");
  EXPECT_TRUE(sim.diagnostics().finite);
  EXPECT_EQ(seen, (std::set{Propagation::kNone, Propagation::kA, Propagation::kB, Propagation::kC}));
  EXPECT_LE(most, 0.1 + 1e-6);
  EXPECT_GE(least, -0.1 - 1e-6);
}

/// Kinetic energy four seconds into the overhand's script, J. Nothing should move faster than a hand then, so a correct
/// value is some joules.
double motion_J(const scene::Scene& scene) {
  Simulation sim = make(scene);
  play(sim, overhand(), 0.0, 4.0);
  EXPECT_TRUE(sim.diagnostics().finite);
  return sim.diagnostics().kinetic_J;
}

// Damping with the printed signs adds energy: the thread moves violently as soon as it is bent.
TEST(AsInThePaper, PrintedSignsMakeEveryModelStormThatHasThem) {
  EXPECT_LT(motion_J(shipped("paper-printed.toml", {"suture.model=paper-1"})), 30.0);
  EXPECT_LT(motion_J(shipped("paper-printed.toml")), 30.0);
  for (const char* model : {"paper-3", "paper-4", "paper-5"}) {
    const std::string set = std::string("suture.model=") + model;
    EXPECT_GT(motion_J(shipped("paper-printed.toml", {set})), 1e4) << model;
    EXPECT_LT(motion_J(shipped("paper-corrected.toml", {set})), 30.0) << model;
  }
}

TEST(AsInThePaper, PrintedRunsThroughAWholeScript) {
  Simulation sim = make(shipped("paper-printed.toml"));
  play(sim, overhand(), 0.0, 10.0);
  EXPECT_TRUE(sim.diagnostics().finite);
}

/// Positions four seconds into the overhand's script.
std::vector<Vec3> after_a_second(const std::vector<std::string>& overrides) {
  Simulation sim = make(paper_scene(overrides));
  play(sim, overhand(), 0.0, 4.0);
  return {sim.nodes_W().begin(), sim.nodes_W().end()};
}

// Section III of the paper: a force whose constant is 0 is left out. Model 4 without some of its forces is exactly
// model 1, 2 or 3, so other combinations must follow their constants, too.
TEST(AsInThePaper, AForceWithConstantZeroIsNotThere) {
  const std::string no_bend = "suture.bend=0", no_damper = "suture.bend_damping=0",
                    no_swivel = "suture.swivel_damping=0";
  const struct {
    const char* model;
    std::vector<std::string> without;
  } kCases[] = {
      {"paper-3", {no_swivel}}, {"paper-2", {no_swivel, no_damper}}, {"paper-1", {no_swivel, no_damper, no_bend}}};
  for (const char* damping : {"implicit", "explicit"}) {
    const std::string how = std::string("suture.damping=") + damping;
    const auto all = after_a_second({how});
    for (const auto& c : kCases) {
      auto overrides = c.without;
      overrides.push_back(how);
      const auto combined = after_a_second(overrides);
      const auto model = after_a_second({how, std::string("suture.model=") + c.model});
      EXPECT_EQ(combined, model) << c.model << ", " << damping;
      EXPECT_NE(combined, all) << c.model << ", " << damping;
    }
  }
}

// A combination that is none of the five models: bending without its damper, but with the swivel damper.
TEST(AsInThePaper, ACombinationThatIsNoModelRuns) {
  const auto free = after_a_second({"suture.bend_damping=0"});
  EXPECT_NE(free, after_a_second({}));
  EXPECT_NE(free, after_a_second({"suture.model=paper-2"}));
}

}  // namespace
}  // namespace ligature::physics
