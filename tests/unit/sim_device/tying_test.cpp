// A hand that ties: play-back of planned positions, two plans that receive the same messages, refused options.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/tying/tying_link.hpp"
#include "sim_device/tying/tying_plan.hpp"
#include "tests/support/random.hpp"

namespace ligature::sim {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Time kStart = seconds(100);  // the drives were enabled for the first time

scene::Scene scene_of(const char* name, const std::vector<std::string>& overrides = {}) {
  return std::get<scene::Scene>(scene::load_scene(std::string(LIGATURE_SOURCE_DIR "/scenes/") + name, overrides));
}

const scene::Scene& suture() {
  static const scene::Scene scene = scene_of("suture-3-0.toml");
  return scene;
}

const WorkspaceMap& map() {
  static const WorkspaceMap map(suture().hands);
  return map;
}

/// A smooth path and its velocity, in the world, over the time since kStart.
Vec3 way(double t_s) { return Vec3(0.02 * std::sin(3.0 * t_s), 0.01 * std::cos(5.0 * t_s), 0.2 + 0.01 * t_s); }
Vec3 speed(double t_s) { return Vec3(0.06 * std::cos(3.0 * t_s), -0.05 * std::sin(5.0 * t_s), 0.01); }
constexpr double kFastest_m_per_s = 0.08;

WishedTick wished(int tick) {
  const double t_s = 1e-3 * tick;
  WishedTick wish{(kStart + milliseconds(tick)).count(), {}, false};
  wish.hands[kRightHand] = {way(t_s), speed(t_s), tick >= 1000};
  wish.hands[kLeftHand] = {Vec3::Zero(), Vec3::Zero(), false};
  return wish;
}

/// The right hand. Its wanted positions arrive in batches of 20 ticks, each `late_s` after its last tick was due.
struct Played {
  PlayedHand hand{map(), kRightHand, way(0.0)};
  int next = 0;
  std::vector<WishedTick> batch{};

  void look(double t_s, double late_s) {
    batch.clear();
    while (1e-3 * (next + 19) + late_s <= t_s)
      for (int i = 0; i < 20; ++i) batch.push_back(wished(next++));
    hand.look(t_s, kStart, batch);
  }
};

TEST(PlayedHand, PlaysWhatWasWishedTheDelayAgoAndBetweenTwoTicks) {
  Played p;
  for (int k = 0; k <= 20'000; ++k) {
    const double t_s = 1e-4 * k, then_s = t_s - PlayedHand::kDelay_s;
    if (k % 7 == 0) p.look(t_s, 0.005);  // calls of look() at other times than ticks
    if (t_s < 0.2) continue;
    const Intent now = p.hand.at(t_s);
    ASSERT_LT((map().to_world(now.p_DH) - way(then_s)).norm(), 1e-9) << t_s;
    ASSERT_LT((map().scale * now.v_DH - speed(then_s)).norm(), 1e-6) << t_s;
    ASSERT_EQ(now.grip, then_s >= 1.0 - 1e-9) << t_s;
    ASSERT_TRUE(now.dead_man);
  }
}

TEST(PlayedHand, NeverJumpsHoweverLateTheBatchesAre) {
  ligature::test::Random random(3);
  Played p;
  double late_s = 0.2;  // of the first batch, too
  Vec3 before = p.hand.at(0.0).p_DH;
  for (int k = 0; k <= 600'000; ++k) {
    const double t_s = 1e-4 * k;
    if (k > 0 && k % 2000 == 0) late_s = random.happens(0.3) ? random.in(0.1, 0.4) : random.in(0.0, 0.04);
    if (k % 10 == 0) p.look(t_s, late_s);
    const Intent now = p.hand.at(t_s);
    ASSERT_LT((now.p_DH - before).norm(), 1.5 * kFastest_m_per_s / map().scale * 1e-4 + 1e-12) << t_s;
    before = now.p_DH;
  }
}

TEST(PlayedHand, RestsAtTheLastWishAndCatchesUpAfterwards) {
  Played p;
  for (int k = 0; k <= 1000; ++k) p.look(1e-3 * k, 0.0);
  const int last = p.next - 1;
  for (int k = 1001; k <= 1300; ++k) p.look(1e-3 * k, 10.0);  // no batches arrive
  EXPECT_LT((map().to_world(p.hand.at(1.3).p_DH) - way(1e-3 * last)).norm(), 1e-9);
  EXPECT_EQ(p.hand.at(1.3).v_DH.norm(), 0.0);
  for (int k = 1301; k <= 1400; ++k) p.look(1e-3 * k, 0.0);
  EXPECT_LT(map().to_world(p.hand.at(1.4).p_DH).z(), way(1.4 - PlayedHand::kDelay_s).z() - 0.001) << "still behind";
  const Vec3 moved = p.hand.at(1.4 + 1e-5).p_DH - p.hand.at(1.4).p_DH;
  EXPECT_LT((p.hand.at(1.4).v_DH - moved / 1e-5).norm(), 1e-3 * kFastest_m_per_s) << "faster than it was wished";
  for (int k = 1401; k <= 4000; ++k) p.look(1e-3 * k, 0.0);
  EXPECT_LT((map().to_world(p.hand.at(4.0).p_DH) - way(4.0 - PlayedHand::kDelay_s)).norm(), 1e-5);
}

TEST(PlayedHand, LetsGoOfTheDeadManWhileItSeesNothing) {
  Played p;
  p.hand.look(0.0, kStart, {});
  EXPECT_FALSE(p.hand.at(0.0).dead_man) << "nothing was ever heard";
  for (int k = 0; k <= 1000; ++k) p.look(1e-3 * k, 0.0);
  const double last_s = 1e-3 * (p.next - 1);
  EXPECT_TRUE(p.hand.at(last_s + PlayedHand::kLongestSilence_s).dead_man);
  EXPECT_FALSE(p.hand.at(last_s + PlayedHand::kLongestSilence_s + 1e-6).dead_man);
  p.look(3.0, 0.0);
  EXPECT_TRUE(p.hand.at(3.0).dead_man);
}

/// A tick that is due in the far future (by another machine's clock) would keep the dead-man pressed until then.
TEST(PlayedHand, TakesNoTickOfAnotherClockAndNoneTwice) {
  Played p;
  const std::vector<WishedTick> ahead{wished(60'000)}, old{wished(10), wished(5), wished(10)};
  p.hand.look(0.1, kStart, ahead);
  EXPECT_FALSE(p.hand.at(0.1).dead_man);
  p.hand.look(0.1, kStart, old);
  EXPECT_TRUE(p.hand.at(0.1).dead_man);
  EXPECT_LT((map().to_world(p.hand.at(0.1).p_DH) - way(0.010)).norm(), 1e-12);
}

TEST(PlayedHand, EndsWhenTheLastWishOfThePlanIsPlayed) {
  Played p;
  p.look(0.5, 0.0);
  EXPECT_EQ(p.hand.end_s(), kEndless_s);
  std::vector<WishedTick> last{wished(500), wished(501), wished(502)};
  last[1].is_done = last[2].is_done = true;
  p.hand.look(0.51, kStart, last);
  EXPECT_DOUBLE_EQ(p.hand.end_s(), 0.501 + PlayedHand::kDelay_s);
}

TEST(PlayedHand, RestsAtItsStartUntilTheDrivesAreOn) {
  Played p;
  const std::vector<WishedTick> some{wished(0), wished(1)};
  p.hand.look(-std::numeric_limits<double>::infinity(), kNever, some);
  EXPECT_EQ(p.hand.at(-std::numeric_limits<double>::infinity()).p_DH, p.hand.start_D_m());
  EXPECT_EQ(p.hand.at(1.0).p_DH, p.hand.start_D_m());
}

KnotTier tier(const char* knot, std::uint32_t seed) { return std::get<KnotTier>(KnotTier::make(suture(), knot, seed)); }

/// Messages without a rig: the thread hangs almost at rest, the tools are where the plan `leads` moves them, and closed
/// jaws hold the thread.
class Stream {
 public:
  ligature_msg::thread_t thread() {
    ligature_msg::thread_t m{};
    for (int k = 0; k < 31; ++k)
      m.p_W_m.push_back({static_cast<float>(random_.in(0.0, 1e-5) * k), 0.0F, 0.35F - 0.01F * static_cast<float>(k)});
    m.count = static_cast<std::int32_t>(m.p_W_m.size());
    return m;
  }
  ligature_msg::tick_batch_t batch(const TyingPlan& leads, double gain = 1.0) {
    ligature_msg::tick_batch_t m{};
    m.session = session;
    for (int i = 0; i < 20; ++i) {
      ligature_msg::tick_t t{};
      t.tick = next++;
      t.scheduled_ns = 1'000'000 * t.tick;
      for (std::size_t h = 0; h < 2; ++h) {
        const HandWish& wish = leads.tier().wish()[h];
        for (Eigen::Index axis = 0; axis < 3; ++axis) t.p_WT_m[h][axis] = wish.p_W[axis];
        t.f_device_N[h][2] = random_.in(-0.01, 0.0);
        t.grasped_node[h] = static_cast<std::int16_t>(wish.grip ? 20 : -1);
        t.gain[h] = gain;
      }
      m.ticks.push_back(t);
    }
    m.count = 20;
    return m;
  }
  std::int64_t session = 5, next = 0;

 private:
  ligature::test::Random random_{11};
};

bool same_bits(const WishedTick& a, const WishedTick& b) {
  bool same = a.due_ns == b.due_ns && a.is_done == b.is_done;
  for (std::size_t h = 0; h < 2; ++h)
    same = same && a.hands[h].p_W == b.hands[h].p_W && a.hands[h].v_W == b.hands[h].v_W &&
           a.hands[h].grip == b.hands[h].grip;
  return same;
}

TEST(TyingPlan, TwoThatHearTheSamePlanTheSameToTheBit) {
  TyingPlan left(tier("square", 4), suture()), right(tier("square", 4), suture()), other(tier("square", 5), suture());
  Stream stream;
  std::vector<WishedTick> of_left, of_right, of_other;
  bool gripped = false;
  for (int k = 0; k < 1000; ++k) {  // 20 s
    const auto thread = stream.thread();
    const auto batch = stream.batch(left);
    for (TyingPlan* plan : {&left, &right, &other}) plan->take(thread);
    left.take(batch, of_left);
    right.take(batch, of_right);
    other.take(batch, of_other);
    gripped = gripped || left.tier().wish()[kLeftHand].grip;
  }
  ASSERT_EQ(of_left.size(), 20'000U);
  ASSERT_EQ(of_right.size(), 20'000U);
  for (std::size_t i = 0; i < of_left.size(); ++i) ASSERT_TRUE(same_bits(of_left[i], of_right[i])) << i;
  EXPECT_TRUE(gripped) << "it saw the thread, and took it";
  EXPECT_EQ(left.tier().doing(), right.tier().doing());
  EXPECT_FALSE(same_bits(of_left.back(), of_other.back()));
}

TEST(TyingPlan, BeginsWhenBothHandsAreInForceAndRestsUntilThen) {
  TyingPlan plan(tier("square", 4), suture());
  const auto start = plan.tier().wish();
  Stream stream;
  std::vector<WishedTick> wishes;
  for (int k = 0; k < 100; ++k) {
    auto batch = stream.batch(plan);
    for (auto& t : batch.ticks) t.gain[kLeftHand] = 0.999;
    plan.take(stream.thread());
    plan.take(batch, wishes);
  }
  ASSERT_EQ(wishes.size(), 2000U) << "each tick has a wish all the same: it says that the hand sees";
  EXPECT_EQ(wishes.back().hands[0].p_W, start[0].p_W);
  EXPECT_EQ(wishes.back().hands[1].v_W, Vec3::Zero());
  plan.take(stream.batch(plan), wishes);
  EXPECT_NE(wishes.back().hands[0].p_W, start[0].p_W);
  for (int k = 0; k < 100; ++k)
    plan.take(stream.batch(plan, 0.0), wishes);  // a plan that has begun continues without force
  EXPECT_GT((wishes.back().hands[0].p_W - start[0].p_W).norm() + (wishes.back().hands[1].p_W - start[1].p_W).norm(),
            0.0);
}

TEST(TyingPlan, BelongsToOneRunOfTheFirmware) {
  TyingPlan plan(tier("square", 4), suture());
  Stream stream;
  std::vector<WishedTick> wishes;
  plan.take(stream.batch(plan, 0.0), wishes);
  stream.session = 6, stream.next = 0;  // the firmware was restarted before the plan began
  plan.take(stream.batch(plan), wishes);
  EXPECT_EQ(wishes.size(), 40U);
  stream.session = 7, stream.next = 0;
  plan.take(stream.batch(plan), wishes);
  EXPECT_EQ(wishes.size(), 40U);
  EXPECT_EQ(plan.lost_ticks(), 0);
}

TEST(TyingPlan, PassesLostTicksBlindlyAndCountsThem) {
  TyingPlan all(tier("square", 4), suture()), gappy(tier("square", 4), suture());
  Stream stream;
  std::vector<WishedTick> of_all, of_gappy;
  for (int k = 0; k < 10; ++k) {
    const auto batch = stream.batch(all);
    all.take(batch, of_all);
    if (k != 5) gappy.take(batch, of_gappy);
  }
  EXPECT_EQ(gappy.lost_ticks(), 20);
  EXPECT_EQ(all.lost_ticks(), 0);
  EXPECT_EQ(of_gappy.size() + 20, of_all.size());
  EXPECT_TRUE(same_bits(of_all.back(), of_gappy.back())) << "without a thread to see, time is all there is";
  const auto before = of_gappy.back();
  stream.next += std::int64_t{1} << 50;  // a forged number must not hold the process up
  gappy.take(stream.batch(all), of_gappy);
  EXPECT_GT(gappy.lost_ticks(), std::int64_t{1} << 49);
  EXPECT_FALSE(same_bits(before, of_gappy.back()));
}

TEST(TyingPlan, TakesNoNumberThatIsNone) {
  TyingPlan plan(tier("square", 4), suture());
  Stream stream;
  std::vector<WishedTick> wishes;
  plan.take(stream.thread());
  for (const int what : {0, 1, 2}) {
    auto batch = stream.batch(plan);
    (what == 0   ? batch.ticks[7].p_WT_m[1][2]
     : what == 1 ? batch.ticks[7].f_device_N[0][1]
                 : batch.ticks[7].gain[1]) = kNaN;
    plan.take(batch, wishes);
  }
  EXPECT_TRUE(wishes.empty());
  auto thread = stream.thread();
  thread.p_W_m[3][1] = std::numeric_limits<float>::infinity();
  plan.take(thread);
  for (int k = 0; k < 500; ++k) plan.take(stream.batch(plan), wishes);
  EXPECT_TRUE(wishes.back().hands[0].p_W.allFinite());
}

std::string refusal(const std::string& word, const scene::Scene& scene) {
  const auto made = tier_of(word, scene);
  const auto* why = std::get_if<std::string>(&made);
  return why == nullptr ? "" : *why;
}

TEST(TierOf, NamesKnotAndSeedOrSaysWhatIsAllowed) {
  EXPECT_EQ(refusal("tie:square", suture()), "");
  EXPECT_EQ(refusal("tie:surgeon:4294967295", suture()), "");
  const auto one = std::get<KnotTier>(tier_of("tie:square", suture())), also = tier("square", 1),
             two = tier("square", 2);
  EXPECT_EQ(one.wish()[0].p_W, also.wish()[0].p_W);
  EXPECT_NE(one.wish()[0].p_W, two.wish()[0].p_W);
  EXPECT_EQ(refusal("untie", scene_of("desk.toml")), "");
  EXPECT_EQ(refusal("untie:x", scene_of("desk.toml")), "seed: found \"x\", allowed 0 .. 4294967295");
  EXPECT_EQ(refusal("tie:untie", scene_of("desk.toml")),
            "knot: found \"untie\", allowed overhand, figure-eight, square, granny, surgeon; or the word untie alone");
  EXPECT_EQ(refusal("tie:bow", suture()),
            "knot: found \"bow\", allowed overhand, figure-eight, square, granny, surgeon");
  EXPECT_NE(refusal("tie:", suture()).find("found \"\""), std::string::npos);
  for (const char* seed : {"", "-1", "x", "1x", "4294967296", "1:2"})
    EXPECT_EQ(refusal(std::string("tie:square:") + seed, suture()),
              std::string("seed: found \"") + seed + "\", allowed 0 .. 4294967295");
  EXPECT_EQ(refusal("tie:surgeon", scene_of("paper.toml")).substr(0, 16), "suture.length_m:");
  EXPECT_EQ(refusal("tie:square", scene_of("paper.toml", {"suture.nodes=20"})).substr(0, 13), "suture.nodes:");
}

/// The thread keeps its knot and holds the right hand by a spring, as a jammed knot would.
TEST(TierOf, AnUntyingHandStopsAtAJammedKnotAndReportsIt) {
  const auto scene = scene_of("desk.toml");
  auto tier = std::get<KnotTier>(tier_of("untie", scene));
  std::vector<Vec3> thread;
  for (const auto& p : scene.suture.initial_polyline_m) thread.emplace_back(p[0], p[1], p[2]);
  Sight sight;
  sight.thread_W = thread;
  double most_N = 0.0;
  int grips = 0;
  Vec3 held_W = Vec3::Zero();
  for (int k = 0; k < 120'000 && !tier.is_done(); ++k) {
    const HandWish& right = tier.wish()[kRightHand];
    if (right.grip && sight.force_W_N[kRightHand].isZero()) held_W = right.p_W, ++grips;
    sight.tool_W = {tier.wish()[kLeftHand].p_W, right.p_W};
    sight.force_W_N[kRightHand] =
        right.grip ? Vec3(scene.hands.coupling_N_per_m * (held_W - right.p_W) + 1e-9 * Vec3::UnitX()) : Vec3::Zero();
    most_N = std::max(most_N, sight.force_W_N[kRightHand].norm());
    tier.tick(sight);
  }
  ASSERT_TRUE(tier.is_done());
  EXPECT_EQ(grips, 3);
  EXPECT_LT(most_N * scene.hands.force_scale, 1.0) << "the hand of a person who follows would feel 3.3 N";
  ASSERT_FALSE(tier.missed().empty());
  EXPECT_EQ(tier.missed().back(), "see that no knot is left");
}

}  // namespace
}  // namespace ligature::sim
