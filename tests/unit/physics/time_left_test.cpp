// A tick of the physics ends between two pieces of work when its time is over; the thread does not move for the rest of
// the tick. A rerun that ends its ticks after the same pieces gives the same result.
#include <gtest/gtest.h>

#include "ligature_source_dir.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/physics/script_run.hpp"

namespace ligature::physics {
namespace {

scene::Scene scene_of(const std::string& file, const std::vector<std::string>& overrides = {}) {
  auto loaded = scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/" + file, overrides);
  if (auto* error = std::get_if<scene::Error>(&loaded)) throw std::runtime_error(error->text);
  return std::get<scene::Scene>(loaded);
}

/// A clock that advances by a random amount at each query, so that the time is over in some ticks.
struct FakeTime {
  explicit FakeTime(std::uint64_t seed) : random(seed) {}
  TimeLeft tick(std::int64_t ns) {
    left_ns = ns;
    return {[](void* self) noexcept { return static_cast<FakeTime*>(self)->pass(); }, this};
  }
  std::int64_t pass() noexcept {
    ++questions;
    return left_ns -= static_cast<std::int64_t>(random() % 40'000);
  }
  ligature::test::Random random;
  std::int64_t left_ns = 0;
  long questions = 0;
};

/// Both ends of the thread are held and pulled apart.
struct Pull {
  explicit Pull(const scene::Scene& scene) : sim(test::make(scene)), ends{sim.nodes_W().front(), sim.nodes_W().back()} {
    along = (ends[1] - ends[0]).normalized();
  }
  void tick(const TimeLeft& left) {
    const Vec3 far = 2e-4 * k * along, fast = 0.2 * along;
    sim.tick({ToolInput{ends[0] - far, -fast, k > 2}, ToolInput{ends[1] + far, fast, k > 2}}, left);
    ++k;
  }
  Simulation sim;
  std::array<Vec3, 2> ends;
  Vec3 along;
  int k = 0;
};

void expect_same(const Simulation& a, const Simulation& b) {
  for (std::size_t i = 0; i < a.nodes_W().size(); ++i) {
    ASSERT_EQ(a.nodes_W()[i], b.nodes_W()[i]);
    ASSERT_EQ(a.velocities_W()[i], b.velocities_W()[i]);
  }
  for (const Hand h : {Hand::kLeft, Hand::kRight}) ASSERT_EQ(a.hand(h).f_W, b.hand(h).f_W);
}

const char* const kScenes[] = {"paper.toml", "desk.toml", "suture-3-0-knot.toml", "suture-3-0-square.toml"};

TEST(TimeLeft, AClockThatIsNeverOverChangesNothing) {
  for (const char* file : kScenes) {
    Pull free(scene_of(file)), told(scene_of(file));
    FakeTime time(1);
    for (int k = 0; k < 40; ++k) {
      free.tick({});
      told.tick(time.tick(std::int64_t{1} << 60));
      ASSERT_EQ(told.sim.diagnostics().cut_at, -1);
    }
    EXPECT_GE(time.questions, 2 * 40) << file;
    expect_same(free.sim, told.sim);
  }
}

TEST(TimeLeft, ATickThatTheClockEndedIsTheSameAgainFromItsQuestion) {
  constexpr std::uint64_t seed = 74;
  for (const char* file : kScenes) {
    Pull live(scene_of(file)), again(scene_of(file));
    FakeTime time(seed);
    int cut = 0;
    for (int k = 0; k < 60; ++k) {
      const std::uint64_t most_ns = k % 3 == 0 ? 60'000 : 900'000;
      live.tick(time.tick(static_cast<std::int64_t>(time.random() % most_ns)));
      const Diagnostics& d = live.sim.diagnostics();
      ASSERT_EQ(d.end == TickEnd::kClock, d.cut_at >= 0);
      cut += d.cut_at >= 0;
      again.tick(d.cut_at >= 0 ? TimeLeft::until_question(d.cut_at) : TimeLeft{});
      ASSERT_EQ(again.sim.diagnostics().cut_at, d.cut_at);
      ASSERT_EQ(again.sim.diagnostics().time_lost, d.time_lost);
      expect_same(live.sim, again.sim);
      if (HasFatalFailure()) FAIL() << file << ", tick " << k << ", seed " << seed;
    }
    EXPECT_GT(cut, 5) << file << ", seed " << seed;
  }
}

TEST(TimeLeft, WithoutTimeTheThreadStandsStillAndTheHandsHoldOn) {
  for (const char* file : kScenes) {
    Pull pull(scene_of(file));
    for (int k = 0; k < 30; ++k) pull.tick({});
    const std::vector<Vec3> before(pull.sim.nodes_W().begin(), pull.sim.nodes_W().end());
    const int node = pull.sim.hand(Hand::kLeft).node;
    ASSERT_GE(node, 0);
    pull.tick(TimeLeft::until_question(0));
    const Diagnostics& d = pull.sim.diagnostics();
    EXPECT_EQ(d.end, TickEnd::kClock);
    EXPECT_DOUBLE_EQ(d.time_lost, 1.0) << file;
    EXPECT_EQ(d.degradation, Degradation::kMotion);
    EXPECT_TRUE(d.finite);
    EXPECT_EQ(pull.sim.hand(Hand::kLeft).node, node);
    EXPECT_GT(pull.sim.hand(Hand::kLeft).f_W.norm(), 0.0) << file;
    double moved = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) moved = std::max(moved, (pull.sim.nodes_W()[i] - before[i]).norm());
    EXPECT_EQ(moved, 0.0) << file;
  }
}

/// A tick without time reports the previous state: after a reset that is the start, not the state before the reset.
TEST(TimeLeft, AThreadThatWasResetIsLikeANewOneFromTheFirstQuestionOn) {
  for (const auto& scene : {scene_of("paper.toml"), scene_of("paper.toml", {"contact.solver=\"paper\""}),
                            scene_of("desk.toml"), scene_of("suture-3-0-square.toml")}) {
    Pull fresh(scene), again(scene);
    for (int k = 0; k < 40; ++k) again.tick({});
    again.sim.reset();
    again.k = 0;
    for (int k = 0; k < 12; ++k) {
      const TimeLeft left = k == 0 || k == 7 ? TimeLeft::until_question(0) : TimeLeft{};
      fresh.tick(left);
      again.tick(left);
      const Diagnostics &a = fresh.sim.diagnostics(), &b = again.sim.diagnostics();
      ASSERT_EQ(a.kinetic_J, b.kinetic_J) << scene::name(scene.suture.model) << ", tick " << k;
      ASSERT_EQ(a.potential_J, b.potential_J) << k;
      ASSERT_EQ(a.max_stretch, b.max_stretch) << k;
      ASSERT_EQ(a.min_gap_m, b.min_gap_m) << k;
      ASSERT_EQ(a.contacts, b.contacts) << k;
      expect_same(fresh.sim, again.sim);
    }
  }
}

/// The clock must be queried often: no long piece of work may lie between two queries.
TEST(TimeLeft, AJamAsksOftenEnough) {
  struct Counted {
    long questions = 0;
  } counted;
  Pull pull(scene_of("suture-3-0-square.toml"));
  const TimeLeft never{[](void* c) noexcept { return ++static_cast<Counted*>(c)->questions, std::int64_t{1} << 60; },
                       &counted};
  for (int k = 0; k < 200; ++k) pull.tick(never);
  EXPECT_GE(counted.questions, 200 * 16 * 4)
      << "at the start of a substep, before its matrix, its solution and each pass";
}

TEST(TimeLeft, TheWorkOfATickCanBeSetAndStaysOverAReset) {
  Pull pull(scene_of("suture-3-0-square.toml"));
  const long whole = pull.sim.work();
  ASSERT_GT(whole, 0);
  pull.sim.set_work(whole / 20);
  pull.sim.reset();
  EXPECT_EQ(pull.sim.work(), whole / 20);
  double lost = 0.0;
  for (int k = 0; k < 40; ++k) {
    pull.tick({});
    lost += pull.sim.diagnostics().time_lost;
    ASSERT_NE(pull.sim.diagnostics().end, TickEnd::kClock);
  }
  EXPECT_GT(lost, 0.0);
  EXPECT_EQ(test::make(scene_of("paper.toml")).work(), 0);
}

}  // namespace
}  // namespace ligature::physics
