// Scenes with extreme parameters: the result is finite, or the simulation reports where it stopped and keeps the last
// finite state. Never a NaN, never a hang.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

using test::make;
using test::overhand;
using test::paper_scene;

bool all_finite(const Simulation& sim) {
  for (const Vec3& p : sim.nodes_W())
    if (!p.allFinite()) return false;
  for (const Vec3& v : sim.velocities_W())
    if (!v.allFinite()) return false;
  const Diagnostics& d = sim.diagnostics();
  bool fine = std::isfinite(d.kinetic_J) && std::isfinite(d.potential_J) && std::isfinite(d.max_stretch) &&
              !std::isnan(d.min_gap_m);
  for (const Hand h : {Hand::kLeft, Hand::kRight})
    fine = fine && sim.hand(h).f_W.allFinite() && sim.hand(h).p_WG.allFinite();
  return fine;
}

/// Plays the script for 300 ticks and checks that all outputs are finite at every tick.
void expect_finite_or_stopped(Simulation& sim, const std::string& what) {
  const auto script = overhand();
  for (int k = 0; k < 300; ++k) {
    sim.tick({test::tool_at(script.keys[0], k * 1e-3), test::tool_at(script.keys[1], k * 1e-3)});
    ASSERT_TRUE(all_finite(sim)) << what << ", tick " << k;
    if (!sim.diagnostics().finite) {
      EXPECT_GE(sim.diagnostics().bad_node, 0) << what;
      EXPECT_EQ(sim.diagnostics().bad_tick, k) << what;
      return;
    }
  }
}

TEST(Extremes, StiffnessAndDampingOverTwelveDecades) {
  for (const char* key : {"stretch_N", "stretch_damping", "bend", "bend_damping", "swivel_damping"})
    for (const double factor : {0.0, 1e-6, 1e-3, 1e3, 1e6})
      for (const char* model : {"paper-1", "paper-4", "paper-5"}) {
        const double table = std::string(key) == "stretch_N"         ? 800
                             : std::string(key) == "bend"            ? 10
                             : std::string(key) == "stretch_damping" ? 1
                                                                     : 0.1;
        const std::string set = std::string("suture.") + key + "=" + std::to_string(table * factor);
        Simulation sim = make(paper_scene({set, std::string("suture.model=") + model}));
        expect_finite_or_stopped(sim, set + " " + model);
      }
}

TEST(Extremes, MassesStepsSizesAndGravity) {
  for (const std::string set :
       {"suture.node_mass_kg=1e-6", "suture.node_mass_kg=1e3", "time.tick_s=1e-6", "time.tick_s=0.1",
        "world.gravity_m_per_s2=[0.0,0.0,-1e4]", "world.gravity_m_per_s2=[1e4,0.0,0.0]", "suture.nodes=2",
        "suture.nodes=3", "suture.nodes=4", "suture.nodes=2000", "suture.radius_m=10.0", "suture.radius_m=1e-6",
        "contact.friction=1e3"}) {
    for (const char* contact : {"contact.solver=none", "contact.solver=implicit"}) {
      Simulation sim = make(paper_scene({set, contact, "world.grippers_collide=true", "world.desk_height_m=0.0"}));
      expect_finite_or_stopped(sim, set + " " + contact);
    }
    Simulation papers = make(paper_scene({set, "contact.solver=paper"}));
    expect_finite_or_stopped(papers, set + " the paper's contact");
    Simulation limited = make(paper_scene({set, "hands.propagation=true"}));
    expect_finite_or_stopped(limited, set + " propagation");
  }
}

TEST(Extremes, CoincidentAndFoldedNodes) {
  for (const int kind : {0, 1, 2}) {
    Simulation sim = make(paper_scene());
    std::vector<Vec3> p(50, Vec3(0, 0, 5.5));
    for (int i = 0; i < 50 && kind > 0; ++i) {
      const int pair = i / 2;
      p[static_cast<std::size_t>(i)].x() = kind == 1 ? 0.1 * (i % 2) : 0.1 * pair;
    }
    sim.set_state(p, {});
    expect_finite_or_stopped(sim, "kind " + std::to_string(kind));
  }
}

TEST(Extremes, AHandThatTeleportsAMetreEveryTenTicks) {
  for (const char* propagation : {"hands.propagation=false", "hands.propagation=true"}) {
    Simulation sim = make(paper_scene({propagation}));
    for (int k = 0; k < 2000; ++k) {
      const Vec3 p((k / 10) % 2 ? 1.0 : 0.0, 0.0, 2.0);
      sim.tick({ToolInput{p, Vec3::Zero(), true}, ToolInput{p + Vec3(0, 1, 0), Vec3::Zero(), true}});
      ASSERT_TRUE(all_finite(sim)) << propagation << ", tick " << k;
    }
    EXPECT_TRUE(sim.diagnostics().finite) << propagation;
  }
}

TEST(Extremes, InputsThatAreNotNumbersStopTheSimulationAndLeaveTheLastState) {
  Simulation sim = make(paper_scene());
  const ToolInput fine{Vec3(0, 0, 2), Vec3::Zero(), true};
  for (int k = 0; k < 10; ++k) sim.tick({fine, fine});
  const std::vector<Vec3> before(sim.nodes_W().begin(), sim.nodes_W().end());
  ToolInput bad = fine;
  bad.p_WT.x() = std::nan("");
  sim.tick({bad, fine});
  EXPECT_FALSE(sim.diagnostics().finite);
  EXPECT_EQ(sim.diagnostics().bad_tick, 10);
  EXPECT_TRUE(all_finite(sim));
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(sim.nodes_W()[i], before[i]);
  sim.tick({fine, fine});
  EXPECT_EQ(sim.nodes_W()[5], before[5]);
}

}  // namespace
}  // namespace ligature::physics
