// Gripper jaws of finite width: the nodes share the load, the thread slips at Coulomb's limit, and one hand can pass
// the thread to the other.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::test {
namespace {

using physics::Hand;
using physics::ToolInput;
using physics::Vec3;
using physics::rod::RodSimulation;

constexpr double kWeight_N = 8e-5 * 9.81;  // weight per metre

scene::Scene thread(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), {"suture.nodes=61", "suture.spacing=\"uniform\"", "world.grippers_collide=false",
                                     "contact.solver=\"none\""});
  auto read = scene::load_scene(std::string(LIGATURE_SOURCE_DIR) + "/scenes/suture-3-0.toml", overrides);
  if (auto* error = std::get_if<scene::Error>(&read)) throw std::runtime_error(error->text);
  return std::get<scene::Scene>(read);
}

RodSimulation simulation(const scene::Scene& scene) {
  auto made = RodSimulation::make(scene);
  if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
  return std::get<RodSimulation>(std::move(made));
}

std::array<ToolInput, 2> hands_at(Vec3 left, Vec3 right) {
  std::array<ToolInput, 2> tools{};
  tools[0].p_WT = left;
  tools[1].p_WT = right;
  return tools;
}

int held_nodes(const RodSimulation& sim) {
  int count = 0;
  const auto& state = sim.rod().state();
  for (int h = 0; h < state.hold_count; ++h) {
    const auto& hold = state.holds[static_cast<std::size_t>(h)];
    count += hold.node >= 0 && !hold.rigid;
  }
  return count;
}

TEST(Jaws, WithoutWidthHoldOneNode) {
  auto sim = simulation(thread({"hands.pinch_width_m=0.0"}));
  auto tools = hands_at(sim.nodes_W()[30], Vec3(1, 1, 1));
  tools[0].grip = true;
  sim.tick(tools);
  EXPECT_EQ(held_nodes(sim), 1);
  EXPECT_EQ(sim.hand(Hand::kLeft).node, 30);
}

TEST(Jaws, ForcesOnTheNodesAddUpToTheLoad) {  // no fixed node: three nodes between the jaws carry the whole thread
  auto sim = simulation(thread({"hands.pinch_width_m=0.011", "world.fixed=[]"}));
  auto tools = hands_at(sim.nodes_W()[30], Vec3(1, 1, 1));
  tools[0].grip = true;
  for (int k = 0; k < 1500; ++k) sim.tick(tools);
  EXPECT_EQ(held_nodes(sim), 3);
  const Vec3 f = sim.hand(Hand::kLeft).f_W;
  EXPECT_NEAR(f.z(), -0.3 * kWeight_N, 0.01 * 0.3 * kWeight_N);
  EXPECT_NEAR(f.x(), 0.0, 1e-3 * kWeight_N);
}

/// Largest deviation of the hand's force, N, from the force K (p_G - p_T) + B (v_G - v_T) of the coupling's spring and
/// damper between tool T and held point G, while `move` moves the left hand for 800 ticks.
template <class Move>
double off_the_coupling_N(RodSimulation& sim, std::array<ToolInput, 2> tools, Move move) {
  double most = 0.0;
  tools[0].grip = true;
  for (int k = 0; k < 800; ++k) {
    const Vec3 before = tools[0].p_WT;
    move(k, tools[0]);
    tools[0].v_WT = (tools[0].p_WT - before) / 1e-3;
    sim.tick(tools);
    const auto& hand = sim.hand(Hand::kLeft);
    const Vec3 pull_N = 1000.0 * (hand.p_WG - tools[0].p_WT) + 0.5 * (hand.v_WG - tools[0].v_WT);
    if (k > 0) most = std::max(most, (hand.f_W - pull_N).norm());
  }
  return most;
}

TEST(Jaws, TheHandFeelsWhatTheyDoToTheThread) {  // for any position of the nodes between the jaws
  // two nodes share a moment: the thread is bent sideways
  auto aside = simulation(thread({"hands.pinch_width_m=0.004"}));
  EXPECT_LT(off_the_coupling_N(aside, hands_at(aside.nodes_W()[60], Vec3(1, 1, 1)),
                               [](int, ToolInput& tool) { tool.p_WT += Vec3(1e-4, 0, 5e-5); }),
            1e-9);
  // The grip slips from node to node.
  auto slips = simulation(thread({"hands.pinch_width_m=0.004", "hands.pinch_force_N=1.0"}));
  EXPECT_LT(off_the_coupling_N(slips, hands_at(slips.nodes_W()[30], Vec3(1, 1, 1)),
                               [](int, ToolInput& tool) { tool.p_WT.z() -= 2e-5; }),
            1e-9);
}

// The friction of the two jaws is 2 mu N = 0.6 N (N pinch force). Pulled at 20 mm/s, the thread slips at this force
// within 2 %.
TEST(Jaws, SlipAtCoulombsLimit) {
  auto sim = simulation(thread({"hands.pinch_width_m=0.004", "hands.pinch_force_N=1.0"}));
  auto tools = hands_at(sim.nodes_W()[30], Vec3(1, 1, 1));
  tools[0].grip = true;
  double most = 0.0, last = 0.0;
  for (int k = 0; k < 800; ++k) {
    tools[0].v_WT = Vec3(0, 0, -0.02);
    tools[0].p_WT.z() -= 2e-5;
    sim.tick(tools);
    last = sim.hand(Hand::kLeft).f_W.z();
    most = std::max(most, last);
  }
  EXPECT_NEAR(most, 0.6, 0.012);
  EXPECT_NEAR(last, 0.6, 0.012);
  EXPECT_GT(sim.hand(Hand::kLeft).node, 31);  // it has slipped by about 13 mm, two and a half segments
}

/// The same in the other direction: the lower end is held, and the hand pulls upwards.
TEST(Jaws, SlipAtCoulombsLimitTowardsTheFirstNodeToo) {
  auto sim = simulation(thread(
      {"hands.pinch_width_m=0.004", "hands.pinch_force_N=1.0", "world.fixed=[{node=60, position_m=[0,0,-0.3]}]"}));
  auto tools = hands_at(sim.nodes_W()[30], Vec3(1, 1, 1));
  tools[0].grip = true;
  for (int k = 0; k < 800; ++k) {
    tools[0].v_WT = Vec3(0, 0, 0.02);
    tools[0].p_WT.z() += 2e-5;
    sim.tick(tools);
  }
  EXPECT_NEAR(sim.hand(Hand::kLeft).f_W.z(), -0.6, 0.012);
  EXPECT_LT(sim.hand(Hand::kLeft).node, 29);
}

TEST(Jaws, LetGoOfAThreadThatHasSlippedOut) {  // 10 mm of thread are left below the jaws
  auto sim = simulation(thread({"hands.pinch_width_m=0.004", "hands.pinch_force_N=1.0"}));
  auto tools = hands_at(sim.nodes_W()[58], Vec3(1, 1, 1));
  tools[0].grip = true;
  sim.tick(tools);
  ASSERT_EQ(sim.hand(Hand::kLeft).node, 58);
  for (int k = 0; k < 500; ++k) {
    tools[0].v_WT = Vec3(0, 0, -0.05);
    tools[0].p_WT.z() -= 5e-5;
    sim.tick(tools);
  }
  EXPECT_EQ(sim.hand(Hand::kLeft).node, -1);
  EXPECT_EQ(sim.hand(Hand::kLeft).f_W, Vec3(0, 0, 0));
}

/// The right hand has turned the thread about its axis. The twist above the left hand's jaws must stay while the thread
/// slides through them.
TEST(Jaws, KeepTheRollWhateverNodesTheyHold) {
  auto sim = simulation(thread({"hands.pinch_width_m=0.011", "hands.pinch_force_N=1.0"}));
  const auto rolls = [&] {
    int count = 0;
    const auto& state = sim.rod().state();
    for (int h = 0; h < state.hold_count; ++h) {
      const auto& hold = state.holds[static_cast<std::size_t>(h)];
      count += hold.node >= 0 && !hold.rigid && hold.holds_roll;
    }
    return count;
  };
  auto tools = hands_at(sim.nodes_W()[30], sim.nodes_W()[10]);
  tools[0].grip = tools[1].grip = true;
  tools[1].R_WT = Eigen::Quaterniond::Identity();
  for (int k = 1; k <= 500; ++k) {  // the thread hangs along z
    tools[1].R_WT = Eigen::Quaterniond(Eigen::AngleAxisd(1.5 * k / 500.0, Vec3::UnitZ()));
    sim.tick(tools);
  }
  const auto moment = [&] { return sim.rod().forces().twist_moment[20]; };
  const auto length = [&] {
    return sim.rod().state().mesh.s[static_cast<std::size_t>(sim.hand(Hand::kLeft).node)] -
           sim.rod().state().mesh.s[10];
  };
  const double turned = moment() * length();
  ASSERT_GT(std::abs(turned), 0.0);
  int changes = 0, node = sim.hand(Hand::kLeft).node;
  for (int k = 0; k < 800; ++k) {
    tools[0].v_WT = Vec3(0, 0, -0.02);
    tools[0].p_WT.z() -= 2e-5;
    sim.tick(tools);
    changes += std::exchange(node, sim.hand(Hand::kLeft).node) != node;
    ASSERT_EQ(rolls(), 2) << "at " << k << ": each hand's jaws keep it at one node";
    ASSERT_NEAR(moment() * length(), turned, 0.15 * std::abs(turned)) << "at " << k;
  }
  EXPECT_GE(changes, 2);
}

TEST(Jaws, DoNotSlipBelowTheLimit) {
  auto sim = simulation(thread({"hands.pinch_width_m=0.004", "hands.pinch_force_N=1.0"}));
  auto tools = hands_at(sim.nodes_W()[30], Vec3(1, 1, 1));
  tools[0].grip = true;
  sim.tick(tools);
  // 150 mm stretched by 1 mm: EA / 150 = 71 N / 150 in series with the coupling, about 0.3 N.
  tools[0].p_WT.z() -= 1e-3;
  for (int k = 0; k < 500; ++k) sim.tick(tools);
  EXPECT_LT(sim.hand(Hand::kLeft).f_W.z(), 0.58);
  EXPECT_GT(sim.hand(Hand::kLeft).f_W.z(), 0.1);
  EXPECT_EQ(sim.hand(Hand::kLeft).node, 30);
}

TEST(Jaws, HandTheThreadOver) {  // no fixed node; the right hand grips beside the left, which then lets go
  auto sim = simulation(thread({"hands.pinch_width_m=0.004", "world.fixed=[]"}));
  auto tools = hands_at(sim.nodes_W()[20], sim.nodes_W()[26]);
  tools[0].grip = true;
  for (int k = 0; k < 100; ++k) sim.tick(tools);
  tools[1].grip = true;
  for (int k = 0; k < 50; ++k) sim.tick(tools);
  tools[0].grip = false;
  for (int k = 0; k < 500; ++k) sim.tick(tools);
  EXPECT_EQ(sim.hand(Hand::kLeft).node, -1);
  ASSERT_GE(sim.hand(Hand::kRight).node, 0);
  EXPECT_LT((sim.hand(Hand::kRight).p_WG - tools[1].p_WT).norm(), 1e-3);
}

/// Jaws that close anywhere between two nodes, 5 mm apart. The held piece becomes unstretched, which changes the force
/// by 3 %.
TEST(Jaws, CloseOnATautThreadWithoutATug) {
  for (const double share : {0.1, 0.3, 0.45, 0.55, 0.8}) {
    auto sim = simulation(thread({"hands.pinch_width_m=0.004"}));
    auto tools = hands_at(sim.nodes_W()[50], Vec3(1, 1, 1));
    tools[0].grip = true;
    for (int k = 0; k < 500; ++k) {
      tools[0].p_WT.z() -= 1e-5;  // 250 mm stretched by 5 mm: EA x 5 / 250 in series with the coupling, 1.1 N
      sim.tick(tools);
    }
    for (int k = 0; k < 300; ++k) sim.tick(tools);
    const double before = sim.hand(Hand::kLeft).f_W.z();
    tools[1].p_WT = sim.nodes_W()[20] + share * (sim.nodes_W()[21] - sim.nodes_W()[20]);
    tools[1].grip = true;
    double most = 0.0;
    for (int k = 0; k < 300; ++k) {
      sim.tick(tools);
      most = std::max(most, sim.hand(Hand::kRight).f_W.norm());
    }
    EXPECT_GT(before, 0.9);
    EXPECT_LT(most, 0.03 * before) << share;
    EXPECT_NEAR(sim.hand(Hand::kLeft).f_W.z(), before, 0.03 * before) << share;
  }
}

/// Jaws close 14 mm beside the thread, which must jerk neither the thread nor the hand; a rigid grip would pull with 14
/// N for a tick. In the end the hand feels the pull of the thread above it, over the length l: the thread is deflected
/// by x, so it is stretched by sqrt(l^2 + x^2) - l, in series with the coupling, and the pull is turned by x / l.
TEST(Jaws, CloseFarOffWithoutAJerk) {
  for (const double pull_N : {0.0, 1.0}) {
    const std::string load = "world.loads=[{node=60, force_N=[0,0,-" + std::to_string(pull_N) + "]}]";
    auto sim = simulation(thread({"hands.pinch_width_m=0.004", "hands.reach_m=0.02", load}));
    auto tools = hands_at(sim.nodes_W()[40] + Vec3(0.014, 0, 0), Vec3(1, 1, 1));
    for (int k = 0; k < 300; ++k) sim.tick(tools);
    Vec3 before = Vec3::Zero();
    double step_N = 0.0, most_N = 0.0, speed = 0.0;
    tools[0].grip = true;
    for (int k = 0; k < 1000; ++k) {
      sim.tick(tools);
      const Vec3 f = sim.hand(Hand::kLeft).f_W;
      step_N = std::max(step_N, (f - before).norm()), most_N = std::max(most_N, f.norm()), before = f;
      for (const Vec3& v : sim.velocities_W()) speed = std::max(speed, v.norm());
    }
    constexpr double kAbove_m = 0.2, kOff_m = 0.014;
    const double stretch_N = (std::hypot(kAbove_m, kOff_m) - kAbove_m) / (kAbove_m / 71.0 + 1.0 / 1000.0);
    const double held_N = std::hypot(stretch_N, pull_N * kOff_m / kAbove_m);
    std::printf("closed 14 mm off, pulled by %.0f N: %.4f N at last (%.4f), %.4f at most, steps of %.4f N, %.2f m/s\n",
                pull_N, before.norm(), held_N, most_N, step_N, speed);
    EXPECT_LT(step_N, 0.03);  // a rigid grip: 14 N
    EXPECT_LT(most_N, 1.05 * held_N);
    EXPECT_LT(speed, 0.6);  // expected at the jaws: 1.5 x 14 mm / 50 ms = 0.42
    EXPECT_NEAR(before.norm(), held_N, 0.05 * held_N);
  }
}

// A thread is held upright by jaws and pushed sideways at its free end. Jaws that hold two nodes keep its direction;
// jaws on one node do not.
TEST(Jaws, HoldTheDirectionToo) {
  const auto lean = [](const char* width) {
    auto sim = simulation(thread(
        {width, "world.fixed=[]", "world.gravity_m_per_s2=[0,0,0]", "world.loads=[{node=40, force_N=[1e-5,0,0]}]"}));
    auto tools = hands_at(sim.nodes_W()[30], Vec3(1, 1, 1));
    tools[0].grip = true;
    for (int k = 0; k < 3000; ++k) sim.tick(tools);
    return sim.nodes_W()[40].x();
  };
  EXPECT_LT(lean("hands.pinch_width_m=0.006"), 0.003);  // a cantilever of 47 mm: F l^3 / 3 EI = 0.9 mm
  EXPECT_GT(lean("hands.pinch_width_m=0.0"), 0.01);
}

TEST(Jaws, OpenTheyPushTheThreadAsideWithoutHoldingIt) {  // open jaws move through the hanging thread at 0.1 m/s
  const auto swung_m = [](const char* collide) {
    auto read = scene::load_scene(std::string(LIGATURE_SOURCE_DIR) + "/scenes/suture-3-0.toml",
                                  std::vector<std::string>{collide, "suture.nodes=61"});
    auto sim = simulation(std::get<scene::Scene>(read));
    auto tools = hands_at(Vec3(-0.02, 0.0, 0.15), Vec3(1, 1, 1));
    for (int k = 0; k < 600; ++k) {
      tools[0].p_WT.x() += 1e-4;
      tools[0].v_WT.x() = 0.1;
      sim.tick(tools);
      EXPECT_EQ(sim.hand(Hand::kLeft).node, -1);
      EXPECT_EQ(sim.hand(Hand::kLeft).f_W, Vec3(0, 0, 0));
    }
    double at = 0.0;
    for (const Vec3& p : sim.nodes_W())
      if (std::abs(p.z() - 0.15) < 0.01) at = p.x();
    return at;
  };
  EXPECT_GT(swung_m("world.grippers_collide=true"), 0.035);  // the gripper is at 0.04 m
  EXPECT_LT(std::abs(swung_m("world.grippers_collide=false")), 1e-3);
}

}  // namespace
}  // namespace ligature::test
