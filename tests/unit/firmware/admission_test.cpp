// Admission: the shapes are as bad as they claim, and the verdict follows the cost.
#include "firmware/app/admission.hpp"

#include <gtest/gtest.h>

#include "firmware/app/admit_command.hpp"
#include "firmware/app/doctor.hpp"
#include "firmware/app/worst_case.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/platform/realtime.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::app {
namespace {

scene::Scene scene_of(const std::string& name, int nodes) {
  return std::get<scene::Scene>(scene::load_scene(std::string(LIGATURE_SOURCE_DIR) + "/scenes/" + name,
                                                  std::vector<std::string>{"suture.nodes=" + std::to_string(nodes)}));
}
scene::Scene paper(int nodes) { return scene_of("paper.toml", nodes); }

TEST(WorstCase, AWoundThreadKeepsItsNodesAndIsAsDenseAsAsked) {
  const auto p_W = wound_up(200, 0.1, 0.1, {0.0, 0.0, 1.0});
  ASSERT_EQ(p_W.size(), 200U);
  for (std::size_t i = 1; i < p_W.size(); ++i) EXPECT_LE((p_W[i] - p_W[i - 1]).norm(), 0.1 + 1e-12) << i;
  double closest_m = 1.0;
  for (std::size_t i = 0; i < p_W.size(); ++i) {
    EXPECT_TRUE(p_W[i].allFinite());
    for (std::size_t j = i + 4; j < p_W.size(); ++j) closest_m = std::min(closest_m, (p_W[i] - p_W[j]).norm());
  }
  EXPECT_GT(closest_m, 0.07);
  EXPECT_LT(closest_m, 0.13);
}

TEST(WorstCase, ACrumpledThreadIsABallOfItsLength) {
  const auto p_W = crumpled(300, 0.1, 1.0, {0.0, 0.0, 1.0}, 1);
  ASSERT_EQ(p_W.size(), 300U);
  for (std::size_t i = 1; i < p_W.size(); ++i) EXPECT_NEAR((p_W[i] - p_W[i - 1]).norm(), 0.1, 1e-12);
  for (const auto& p : p_W) EXPECT_LT((p - physics::Vec3(0.0, 0.0, 1.0)).norm(), 3.0);
}

TEST(WorstCase, PressedTogetherItFillsTheContactLists) {
  const auto scene = paper(50);
  auto thread = std::get<physics::Simulation>(physics::Simulation::make(scene));
  int most = 0;
  for (const auto& shape : worst_shapes(scene)) {
    thread.reset();
    if (!shape.p_W.empty()) thread.set_state(shape.p_W, shape.v_W);
    thread.tick({});
    most = std::max(most, thread.diagnostics().contacts);
  }
  EXPECT_GE(most, 50) << "more than one contact a node";
}

TEST(Admission, AFewNodesFitAndTooManyDoNot) {
  const int core = platform::realtime_core();
  const auto small = admit(paper(20), 0.1, core);
  EXPECT_TRUE(small.fits()) << table(small);
  EXPECT_GT(small.worst.thread_us, 0.0);
  EXPECT_GT(small.worst.control_us, 0.0);
  EXPECT_GT(small.worst.calls_us, 0.0);
  EXPECT_EQ(small.computing_us(), small.worst.thread_us + small.worst.control_us + small.worst.calls_us);
  EXPECT_NEAR(small.bus_us, 530.0, 80.0);
  const auto large = admit(paper(600), 0.1, core);
  EXPECT_FALSE(large.fits()) << table(large);
  EXPECT_GT(large.worst.thread_us, small.worst.thread_us);
}

TEST(Admission, NamesTheLargestThreadThatFits) {
  const auto nodes = largest_nodes(paper(600), 1.0, measure_on(platform::realtime_core(), 60.0));
  ASSERT_TRUE(nodes);
  EXPECT_GE(*nodes, 20);
  EXPECT_LT(*nodes, 600);
}

TEST(Admission, AThreadThatBeginsInAShapeOfItsOwnIsLaidOutAnew) {
  const auto nodes = largest_nodes(scene_of("desk.toml", 600), 0.5, measure_on(platform::realtime_core(), 60.0));
  ASSERT_TRUE(nodes);
  EXPECT_GE(*nodes, 20);
  EXPECT_LT(*nodes, 600);
}

TEST(Admission, ARodIsMeasuredInTheSameShapes) {
  const auto rod = scene_of("suture-3-0.toml", 12);
  const auto a = admit(rod, 0.05, platform::realtime_core());
  EXPECT_GT(a.worst.thread_us, 0.0);
  EXPECT_GT(a.worst.most_contacts, 0) << "the shapes must press it together";
  const auto text = table(a);
  for (const char* phase : {"bus, SYNC", "calls to both buses", "control law", "thread", "computing", "in all"})
    EXPECT_NE(text.find(phase), std::string::npos) << text;
}

/// A core that takes so long for a tick: something for a rod of that accuracy, and something a node.
Measure costs(double balanced_us, double fast_us, double node_us) {
  return [=](const scene::Scene& scene, double) {
    Admission a;
    a.bus_us = 460.0;
    const bool rod = scene.suture.model == scene::Model::kRod;
    const bool fast = scene.suture.rod.accuracy == scene::Accuracy::kFast;
    a.worst.thread_us = (rod ? fast ? fast_us : balanced_us : 0.0) + node_us * scene.suture.nodes;
    return a;
  };
}
std::string refusal(const scene::Scene& scene, const Measure& measure) {
  const auto objection = objection_of(measure(scene, 0.0), scene, measure);
  EXPECT_EQ(objection ? objection->exit_code : 0, objection ? 3 : 0);
  return objection ? objection->text : "";
}

TEST(Refusal, NamesWhatWasFoundWhatIsAllowedAndTheLargestThreadThatFits) {
  EXPECT_EQ(refusal(paper(600), costs(0, 0, 2.0)),
            "the scene does not fit: found 1200 us of computing in the worst tick, allowed 540; "
            "largest suture.nodes that would: 270");
  EXPECT_EQ(refusal(paper(600), costs(0, 0, 0.9)), "") << "540 us to the dot";
  EXPECT_EQ(
      refusal(paper(600), costs(0, 0, 500.0)),
      "the scene does not fit: found 300000 us of computing in the worst tick, allowed 540; no suture.nodes would");
}

TEST(Refusal, OfARodNamesLessWorkBeforeFewerNodes) {
  const auto rod = scene_of("suture-3-0.toml", 154);
  EXPECT_EQ(refusal(rod, costs(500.0, 300.0, 1.0)),
            "the scene does not fit: found 654 us of computing in the worst tick, allowed 540; "
            "suture.accuracy = \"fast\" would as it is; else largest suture.nodes that would: 40");
  EXPECT_EQ(
      refusal(rod, costs(500.0, 420.0, 1.0)),
      "the scene does not fit: found 654 us of computing in the worst tick, allowed 540; "
      "largest suture.nodes that would: 40; with suture.accuracy = \"fast\": largest suture.nodes that would: 120");
  EXPECT_EQ(refusal(rod, costs(900.0, 700.0, 0.0)),
            "the scene does not fit: found 900 us of computing in the worst tick, allowed 540; "
            "no suture.nodes would; with suture.accuracy = \"fast\": no suture.nodes would");
}

TEST(Refusal, OfARodThatIsFastAlreadyDoesNotNameIt) {
  auto rod = scene_of("suture-3-0.toml", 154);
  rod.suture.rod.accuracy = scene::Accuracy::kFast;
  EXPECT_EQ(refusal(rod, costs(0.0, 500.0, 1.0)).find("accuracy"), std::string::npos);
}

TEST(Refusal, NamesNoThreadThatFitsOnlyOnce) {
  int asked = 0;
  const auto nodes = largest_nodes(paper(64), 1.0, [&](const scene::Scene& scene, double) {
    Admission a;
    a.worst.thread_us = scene.suture.nodes <= (++asked > 6 ? 30 : 40) ? 0.0 : 1000.0;
    return a;
  });
  ASSERT_TRUE(nodes);
  EXPECT_LE(*nodes, 30);
  EXPECT_GE(*nodes, 27);
}

TEST(Admission, SaysWhatTheWorstTickGivesUp) {
  Admission a;
  EXPECT_EQ(table(a).find("gives up"), std::string::npos);
  a.worst.gave_up = physics::Degradation::kMotion;
  a.worst.time_lost = 0.25;
  EXPECT_NE(table(a).find("stands still for up to 25 % of a tick"), std::string::npos) << table(a);
}

TEST(Admission, TheBusCountsAgainstThePeriodNotAgainstTheBudget) {
  Admission a;
  a.bus_us = 450.0;
  a.worst.thread_us = 560.0;
  EXPECT_FALSE(a.fits());  // within 600, but not with the bus
  a.worst.thread_us = 540.0;
  EXPECT_TRUE(a.fits());
  a.bus_us = 100.0;
  a.worst.thread_us = 610.0;
  EXPECT_FALSE(a.fits());
}

TEST(Doctor, JudgesByTheWorstWakeUp) {
  rt::DurationStatistics s;
  for (int i = 0; i < 1000; ++i) s.add(5'000);
  EXPECT_EQ(judge(s).grade, platform::Grade::kOk);
  s.add(150'000);
  EXPECT_EQ(judge(s).grade, platform::Grade::kWarn);
  s.add(2'000'000);
  const auto check = judge(s);
  EXPECT_EQ(check.grade, platform::Grade::kFail);
  EXPECT_NE(check.remedy, "");
  const std::string text = table({check, {platform::Grade::kOk, "kernel", "fine", {}}});
  EXPECT_NE(text.find("FAIL  wake-up latency"), std::string::npos);
  EXPECT_NE(text.find("OK    kernel"), std::string::npos);
  EXPECT_NE(histogram(s, {1, 0, 3}).find("1002 in all"), std::string::npos);
}

}  // namespace
}  // namespace ligature::app
