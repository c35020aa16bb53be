// The thread in its world: gravity, loads, fixed and clamped nodes, desk, grippers, frame, refinement.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/physics/random_states.hpp"
#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

using test::make;
using test::paper_scene;

const std::array<ToolInput, 2> kNoHands{};

void settle(Simulation& sim, double seconds) {
  for (int k = 0; k < static_cast<int>(seconds * 1000); ++k) sim.tick(kNoHands);
}

/// Tip height of a hanging thread of n nodes: segment i carries the n - 1 - i nodes below it, so its length is (rest
/// length) (1 + (n - 1 - i) m g / 800 N).
double hanging_tip_m(int nodes, double mass_kg) {
  double z = 5.5;
  for (int i = 0; i + 1 < nodes; ++i) z -= 5.0 / (nodes - 1) * (1.0 + (nodes - 1 - i) * mass_kg * 9.8 / 800.0);
  return z;
}

TEST(HangingThread, ExtendsByItsWeightOverStiffness) {
  for (const int nodes : {2, 3, 20, 50}) {
    Simulation sim = make(paper_scene({"suture.nodes=" + std::to_string(nodes), "suture.air_drag_per_s=5.0"}));
    settle(sim, 20.0);
    EXPECT_NEAR(sim.nodes_W().back().z(), hanging_tip_m(nodes, 0.05), 1e-6) << nodes << " nodes";
  }
}

// Model 5 stretches less than model 4 with its default constant, but more with the printed one (the paper claims in
// section V.C that it stretches less).
TEST(HangingThread, StretchesLessInModel5OnlyWithTheStiffConstant) {
  const auto tip = [](const char* model, const char* constant) {
    Simulation sim =
        make(paper_scene({std::string("suture.model=") + model, std::string("suture.quadratic_stretch=") + constant,
                          "suture.air_drag_per_s=5.0"}));
    settle(sim, 20.0);
    return 0.5 - sim.nodes_W().back().z();
  };
  const double four = tip("paper-4", "stiff"), stiff = tip("paper-5", "stiff"), printed = tip("paper-5", "printed");
  // Strains of 1.5 % and 11.7 %, as an independent program computed them for 50 nodes.
  EXPECT_NEAR(four / 5.0, 0.0153, 1e-3);
  EXPECT_NEAR(printed / 5.0, 0.117, 2e-3);
  EXPECT_LT(stiff, 0.85 * four);
}

// Reported tensions: each segment carries the nodes below it, for every stretch law.
TEST(HangingThread, TellsTheTensionOfTheWeightBelow) {
  for (const auto& [model, constant] :
       {std::pair{"paper-4", "stiff"}, std::pair{"paper-5", "stiff"}, std::pair{"paper-5", "printed"}}) {
    Simulation sim =
        make(paper_scene({std::string("suture.model=") + model, std::string("suture.quadratic_stretch=") + constant,
                          "suture.nodes=20", "suture.air_drag_per_s=5.0"}));
    settle(sim, 20.0);
    float tension_N[20], turn[20];
    sim.describe(tension_N, turn);
    for (int i = 0; i < 19; ++i) EXPECT_NEAR(tension_N[i] / ((19 - i) * 0.05 * 9.8), 1.0, 2e-3) << model << " " << i;
  }
}

// x += dt v with the velocity before the step (forward) or after it (semi-implicit); free fall distinguishes them.
TEST(Integrator, ForwardMovesByTheVelocityBeforeTheStepSemiImplicitByTheOneAfter) {
  for (const auto& [name, steps] : {std::pair{"forward", 99.0}, std::pair{"semi-implicit", 101.0}}) {
    Simulation sim = make(paper_scene({std::string("suture.integrator=") + name, "world.fixed=[]",
                                       "suture.air_drag_per_s=0.0", "contact.solver=none", "time.substeps=2"}));
    const double from_m = sim.nodes_W()[7].z();
    for (int k = 0; k < 50; ++k) sim.tick(kNoHands);  // 100 substeps of 0.5 ms
    EXPECT_NEAR(sim.nodes_W()[7].z() - from_m, -9.8 * 2.5e-7 * 100.0 * steps / 2.0, 1e-12) << name;
  }
}

// With reference_nodes, weight, stretch and sag of the thread do not depend on `nodes`.
TEST(Refinement, KeepsTheThreadWhenNodesChange) {
  double tip[3];
  int k = 0;
  for (const int nodes : {25, 50, 100}) {
    Simulation sim = make(paper_scene({"suture.nodes=" + std::to_string(nodes), "suture.reference_nodes=50",
                                       "suture.air_drag_per_s=5.0", "time.substeps=4", "contact.solver=none"}));
    settle(sim, 20.0);
    tip[k++] = 0.5 - sim.nodes_W().back().z();
  }
  EXPECT_NEAR(tip[0] / tip[1], 1.0, 0.03);  // end effects are of order 1 / nodes
  EXPECT_NEAR(tip[2] / tip[1], 1.0, 0.02);
}

// A clamped thread without gravity under an end load F: reference_nodes preserves the bending stiffness EI = (bending
// constant) (rest length) / pi, so the small deflection F L^3 / (3 EI) does not depend on `nodes`.
TEST(Refinement, KeepsTheBendingStiffness) {
  for (const int nodes : {26, 51}) {
    Simulation sim = make(
        paper_scene({"suture.nodes=" + std::to_string(nodes), "suture.reference_nodes=51",
                     "world.fixed=[{node=0, position_m=[0.0,0.0,0.0], direction=[1.0,0.0,0.0]}]",
                     "world.gravity_m_per_s2=[0.0,0.0,0.0]", "world.loads=[{node=-1, force_N=[0.0,0.0,-1e-2]}]",
                     "suture.air_drag_per_s=2.0", "contact.solver=none", "suture.bend=1000.0", "time.substeps=4"}));
    std::vector<Vec3> straight;
    for (int i = 0; i < nodes; ++i) straight.emplace_back(5.0 * i / (nodes - 1), 0.0, 0.0);
    sim.set_state(straight, {});
    settle(sim, 20.0);
    const double rest = 5.0 / (nodes - 1), free_m = 5.0 - 0.5 * rest, EI = 1000.0 * 0.1 / 3.14159265358979;
    EXPECT_NEAR(-sim.nodes_W().back().z() / (1e-2 * free_m * free_m * free_m / (3.0 * EI)), 1.0, 0.02)
        << nodes << " nodes";
  }
}

TEST(Clamp, HoldsNodeAndTangent) {
  Simulation sim = make(paper_scene({"world.fixed=[{node=0, position_m=[0.0,0.0,1.0], direction=[0.0,3.0,0.0]}]"}));
  settle(sim, 1.0);
  EXPECT_EQ(sim.nodes_W()[0], Vec3(0, 0, 1));
  EXPECT_NEAR((sim.nodes_W()[1] - Vec3(0, 5.0 / 49, 1)).norm(), 0.0, 1e-15);
}

TEST(Load, AHangingWeightAddsToTheTension) {
  Simulation sim = make(
      paper_scene({"suture.nodes=2", "world.loads=[{node=-1, force_N=[0.0,0.0,-8.0]}]", "suture.air_drag_per_s=5.0"}));
  settle(sim, 20.0);
  EXPECT_NEAR(5.5 - sim.nodes_W()[1].z(), 5.0 * (1 + (8.0 + 0.49) / 800.0), 1e-6);
}

TEST(Desk, CarriesTheThreadAndFrictionStopsIt) {
  Simulation sim = make(paper_scene({"world.desk_height_m=4.0"}));
  settle(sim, 20.0);
  for (const Vec3& p : sim.nodes_W()) EXPECT_GT(p.z(), 4.0 + 0.05 - 0.002);
  EXPECT_GT(sim.diagnostics().contacts, 5);
  EXPECT_LT(sim.diagnostics().kinetic_J, 1e-3);
}

// On a slope with tan(angle) < mu a resting thread stays; on a steeper one it slides. Gravity is tilted instead of the
// desk.
TEST(Desk, StaticFrictionHoldsUpToItsConeAndNotBeyond) {
  for (const auto& [slope, slides] : {std::pair{0.28, false}, std::pair{0.33, true}}) {
    Simulation sim = make(paper_scene({"world.desk_height_m=0.0", "world.fixed=[]", "suture.air_drag_per_s=0.0",
                                       "world.gravity_m_per_s2=[" + std::to_string(9.8 * slope) + ",0.0,-9.8]"}));
    std::vector<Vec3> line;
    for (int i = 0; i < 50; ++i) line.emplace_back(0.0, 5.0 / 49 * i, 0.05);
    sim.set_state(line, {});
    settle(sim, 3.0);
    const double moved = sim.nodes_W()[25].x();
    if (slides)
      EXPECT_NEAR(moved, 0.5 * 9.8 * (slope - 0.3) * 9.0, 0.15);  // acceleration g (tan(angle) - mu)
    else
      EXPECT_LT(std::abs(moved), 1e-6);
  }
}

TEST(Gripper, PushesTheThreadAsideButNotTheOneItHolds) {
  Simulation sim = make(paper_scene({"world.grippers_collide=true"}));
  const auto tools = [](double x) {
    return std::array{ToolInput{Vec3(x, 0.0, 3.0), Vec3(0.5, 0, 0), false},
                      ToolInput{Vec3(9, 9, 9), Vec3::Zero(), false}};
  };
  for (int k = 0; k < 2000; ++k) sim.tick(tools(-0.5 + 0.5e-3 * k));
  double at = 0.0;
  for (const Vec3& p : sim.nodes_W())
    if (std::abs(p.z() - 3.0) < 0.1) at = p.x();
  EXPECT_GT(at, 0.5);  // pushed ahead of the gripper, which is at x = 0.5
  EXPECT_GT(sim.diagnostics().contacts, 0);

  Simulation held = make(paper_scene({"world.grippers_collide=true"}));
  for (int k = 0; k < 1000; ++k)
    held.tick({ToolInput{Vec3(0, 0, 3), Vec3::Zero(), true}, ToolInput{Vec3(9, 9, 9), Vec3::Zero(), false}});
  EXPECT_EQ(held.diagnostics().contacts, 0);
  held.tick({ToolInput{Vec3(0, 0, 3), Vec3::Zero(), false}, ToolInput{Vec3(9, 9, 9), Vec3::Zero(), false}});
  EXPECT_EQ(held.diagnostics().contacts, 0);  // releasing does not kick the thread away
}

// An overlap is reduced by at most 0.01 r per step (r thread radius), i.e. at 0.5 m/s. A faster gripper must push the
// thread along by its own velocity.
TEST(Gripper, TakesAlongWhatItMeetsHoweverFastItIs) {
  for (const double speed : {0.2, 1.0, 3.0}) {
    Simulation sim = make(paper_scene({"world.grippers_collide=true", "world.gravity_m_per_s2=[0.0,0.0,0.0]"}));
    const std::size_t middle = 25;
    const double z = sim.nodes_W()[middle].z(), from_m = -0.2, ticks = 0.4 / speed * 1e3;
    double x = 0.0, deepest_m = 0.0;
    for (int k = 0; k < static_cast<int>(ticks); ++k) {
      x = from_m + 1e-3 * speed * k;
      sim.tick({ToolInput{Vec3(x, 0.1, z), Vec3(speed, 0, 0), false}, ToolInput{Vec3(9, 9, 9), Vec3::Zero(), false}});
      if (x > -0.09) deepest_m = std::max(deepest_m, x + 1e-3 * speed + 0.1 - sim.nodes_W()[middle].x());
    }
    EXPECT_GT(sim.diagnostics().contacts, 0) << speed;
    EXPECT_LT(deepest_m, 0.02 * 0.1) << speed;
    EXPECT_GT(sim.velocities_W()[middle].x(), 0.9 * speed) << speed;
  }
}

TEST(Frame, ItsHookStopsAThreadThrownOverIt) {
  for (const auto& [collides, stopped] : {std::pair{"true", true}, std::pair{"false", false}}) {
    // Gravity acts along +x. The hook reaches from the fixed node against it, by 4 radii along -x; the free end is laid
    // across its tip, two radii (0.1 m) beside its axis, and must touch it. Without frame_collides there is no hook.
    Simulation sim =
        make(paper_scene({std::string("world.frame_collides=") + collides, "world.gravity_m_per_s2=[9.8,0.0,-1e-9]"}));
    std::vector<Vec3> p;
    for (int i = 0; i < 50; ++i) {
      const double s = 5.0 / 49 * i;
      if (s < 1.0)
        p.emplace_back(0.0, s, 5.5);
      else if (s < 1.2)
        p.emplace_back(-(s - 1.0), 1.0, 5.5);
      else
        p.emplace_back(-0.2, 1.0 - (s - 1.2), 5.6);
    }
    sim.set_state(p, {});
    double least = 1.0;
    for (int k = 0; k < 300; ++k) {
      sim.tick(kNoHands);
      if (sim.diagnostics().contacts > 0) least = 0.0;
    }
    EXPECT_EQ(least == 0.0, stopped) << collides;
  }
}

TEST(Grasp, TakesTheNearestNodeThatIsNeitherFixedNorHeld) {
  Simulation sim = make(paper_scene());
  const ToolInput top{Vec3(0, 0, 5.6), Vec3::Zero(), true};
  sim.tick({top, top});
  EXPECT_EQ(sim.hand(Hand::kLeft).node, 1);   // node 0 is fixed, so node 1 is the nearest that can be held
  EXPECT_EQ(sim.hand(Hand::kRight).node, 2);  // node 1 is held by the other hand
  sim.tick({ToolInput{top.p_WT, Vec3::Zero(), false}, top});
  EXPECT_EQ(sim.hand(Hand::kLeft).node, -1);
  EXPECT_EQ(sim.hand(Hand::kLeft).f_W, Vec3::Zero());
  EXPECT_EQ(sim.hand(Hand::kRight).node, 2);
}

TEST(Coupling, PullsTheHandBackTowardsTheNodeAtRestBySpringAlone) {
  Simulation sim = make(paper_scene({"suture.air_drag_per_s=5.0"}));
  const ToolInput hand{Vec3(0.0, 0.0, 0.3), Vec3::Zero(), true}, away{Vec3(9, 9, 9), Vec3::Zero(), false};
  for (int k = 0; k < 20000; ++k) sim.tick({hand, away});
  const HandContact& c = sim.hand(Hand::kLeft);
  EXPECT_EQ(c.node, 49);
  EXPECT_NEAR((c.f_W - 1200.0 * (c.p_WG - hand.p_WT)).norm(), 0.0, 1e-6 * c.f_W.norm());
  EXPECT_GT(c.f_W.z(), 0.0);
}

/// The same run with each broad phase: contacts are bit-identical, therefore the motion is.
/// @param run returns a number of contacts in the run, which must not be 0.
void expect_the_same_motion(int nodes, const std::vector<Vec3>& shape, const std::function<int(Simulation&)>& run) {
  std::vector<Vec3> brute;
  for (const char* search : {"brute", "sweep", "bvh"}) {
    Simulation sim =
        make(paper_scene({std::string("contact.broad_phase=") + search, "suture.nodes=" + std::to_string(nodes)}));
    if (!shape.empty()) sim.set_state(shape, {});
    EXPECT_GT(run(sim), 0) << search;
    if (brute.empty()) brute.assign(sim.nodes_W().begin(), sim.nodes_W().end());
    for (std::size_t i = 0; i < brute.size(); ++i) ASSERT_EQ(sim.nodes_W()[i], brute[i]) << search << ", node " << i;
  }
}

TEST(BroadPhases, MoveAThreadAlikeToTheLastBit) {
  const auto script = test::overhand();
  expect_the_same_motion(50, {}, [&](Simulation& sim) {
    test::play(sim, script, 0.0, 12.0);
    return sim.diagnostics().contacts;
  });
  const auto fall = [](Simulation& sim) {
    int most = 0;  // in any tick: a heap that has fallen apart may have no contact left
    for (int tick = 0; tick < 40; ++tick) {
      sim.tick(kNoHands);
      most = std::max(most, sim.diagnostics().contacts);
    }
    return most;
  };
  test::Random random(8);
  for (int k = 0; k < 5; ++k) {  // heaps that fall apart
    std::vector<Vec3> heap;
    for (int i = 0; i < 50; ++i) {
      const auto at = random.vector(0.4);
      heap.emplace_back(at.x, at.y, at.z);
    }
    expect_the_same_motion(50, heap, fall);
  }
  // Coils whose turns overlap slightly. Segments are a quarter of the diameter long, so that their bounding spheres are
  // hardly larger than the contact distance.
  for (int k = 0; k < 3; ++k) {
    const double radius_m = random.in(0.2, 0.4), pitch_m = random.in(0.08, 0.095);
    std::vector<Vec3> coil;
    for (int i = 0; i < 200; ++i) {
      const double turn = 5.0 / 199.0 * i / radius_m;
      coil.emplace_back(radius_m * std::cos(turn), radius_m * std::sin(turn), 5.5 + pitch_m * turn / 6.283);
    }
    expect_the_same_motion(200, coil, fall);
  }
}

// The paper's contact as a scene option: it separates a folded thread; without contact the thread stays folded.
TEST(PaperSolver, KeepsAFoldedThreadApart) {
  for (const auto& [solver, holds] : {std::pair{"paper", true}, std::pair{"none", false}}) {
    Simulation sim = make(paper_scene({std::string("contact.solver=") + solver, "suture.bend=0.0",
                                       "world.gravity_m_per_s2=[0.0,0.0,0.0]", "world.fixed=[]"}));
    std::vector<Vec3> shape;
    for (int i = 0; i < 50; ++i) shape.emplace_back(0.1 * (i < 25 ? i : 49 - i), i < 25 ? 0.0 : 0.06, 0.0);
    sim.set_state(shape, {});
    settle(sim, 0.5);
    EXPECT_TRUE(sim.diagnostics().finite);
    const double apart_m = (sim.nodes_W()[5] - sim.nodes_W()[44]).norm();
    if (holds)
      EXPECT_GT(apart_m, 0.099);
    else
      EXPECT_LT(apart_m, 0.07);
  }
}

TEST(Simulation, ACopyOfAKnottedThreadGoesOnExactlyLikeTheOriginal) {  // including contacts and their buffers
  const auto script = test::overhand();
  Simulation sim = make(paper_scene());
  test::play(sim, script, 0.0, 16.0);
  Simulation copy = sim;
  test::play(sim, script, 16.0, 18.0);
  test::play(copy, script, 16.0, 18.0);
  EXPECT_GT(sim.diagnostics().contacts, 0);
  for (std::size_t i = 0; i < sim.nodes_W().size(); ++i) EXPECT_EQ(copy.nodes_W()[i], sim.nodes_W()[i]);
}

TEST(Simulation, ResetAndCopyRepeatTheSameRunExactly) {
  const auto script = test::overhand();
  Simulation sim = make(paper_scene());
  test::play(sim, script, 0.0, 2.0);
  const std::vector<Vec3> first(sim.nodes_W().begin(), sim.nodes_W().end());
  sim.reset();
  Simulation copy = sim;
  test::play(sim, script, 0.0, 2.0);
  test::play(copy, script, 0.0, 2.0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(sim.nodes_W()[i], first[i]);
    EXPECT_EQ(copy.nodes_W()[i], first[i]);
  }
}

}  // namespace
}  // namespace ligature::physics
