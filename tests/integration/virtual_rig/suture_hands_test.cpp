// Both hands of the whole rig on the realistic suture, in virtual time: the felt force is the thread's force on the
// jaws; the thread is passed from hand to hand under load; the clutch extends a hand's reach.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ligature_source_dir.hpp"
#include "simulated_rig.hpp"

namespace ligature {
namespace {

constexpr double kThread_N_per_m = 1000.0;  // coupling: spring on the thread's side
// Coupling: both springs in series, with 500 N/m on the device's side.
constexpr double kDevice_N_per_m = kThread_N_per_m * 500.0 / 1500.0;
constexpr double kHand_N_per_m = 800.0;  // stiffness of the simulated hand
constexpr double kEA_N = 71.0, kTop_m = 0.35;
constexpr double kStep_N = 0.5;  // step limit of the device file
constexpr int kNearTop = 5;      // number of a segment near the anchor, which no hand touches

using Keys = std::vector<scene::GripKey>;

scene::Scene suture(const std::vector<std::string>& overrides = {}) {
  return std::get<scene::Scene>(scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/suture-3-0.toml", overrides));
}

double size(const rt::Triple& f) { return std::hypot(f[0], f[1], f[2]); }
double apart(const rt::Triple& a, const rt::Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// A played script, and the tension next to the anchor at each record.
struct Played {
  Played(const scene::Scene& scene, Keys left, Keys right, std::function<void(SimulatedRig&, double)> each = {})
      : rig(scene, script_of(std::move(left), std::move(right))), tension_N(scene.suture.nodes) {
    std::vector<float> turn(tension_N.size());
    rig.each_tick = [this, turn, each]() mutable {
      rig.thread.describe(tension_N, turn);
      top_N.push_back(tension_N[kNearTop]);
      at_s.push_back(script_s());
      if (each) each(rig, at_s.back());
    };
    EXPECT_EQ(rig.run(20'000, true), std::nullopt);
    EXPECT_EQ(rig.records.back().fault, 0);
  }
  static scene::GripperScript script_of(Keys left, Keys right) {
    scene::GripperScript script;
    script.keys[0] = std::move(left), script.keys[1] = std::move(right);
    return script;
  }
  [[nodiscard]] double script_s() const {
    return std::min(rig.left.device.mechanics().script_time_s(), rig.right.device.mechanics().script_time_s());
  }
  [[nodiscard]] std::size_t tick_at(double t_s) const {
    return static_cast<std::size_t>(std::lower_bound(at_s.begin(), at_s.end(), t_s) - at_s.begin());
  }
  [[nodiscard]] double tension_at(double t_s) const { return top_N[tick_at(t_s)]; }
  [[nodiscard]] const rt::TickRecord& at(double t_s) const { return rig.records[tick_at(t_s) - 1]; }
  /// The largest change of the force that is sent, from one period to the next.
  [[nodiscard]] double step_N(std::size_t hand, double from_s = 0.0, double to_s = 1e9) const {
    double most = 0.0;
    for (std::size_t k = std::max<std::size_t>(tick_at(from_s), 1); k < std::min(tick_at(to_s), rig.records.size());
         ++k)
      most = std::max(most, apart(rig.records[k].f_device_N[hand], rig.records[k - 1].f_device_N[hand]));
    return most;
  }

  SimulatedRig rig;
  std::vector<float> tension_N;
  std::vector<double> top_N, at_s;
};

/// Expected tension of a thread of length_m when a hand's target is `way_m` beyond the place of the unstretched
/// thread's end.
double pulled_N(double way_m, double length_m) {
  return way_m / (length_m / kEA_N + 1.0 / kDevice_N_per_m + 1.0 / kHand_N_per_m);
}

/// Jaws hold several nodes, which need not lie symmetrically about the middle of the jaws. The jaws' forces on these
/// nodes make the moment that keeps the thread's direction. The hand must feel only the thread's pull, not these
/// forces.
TEST(SutureHands, FeelWhatTheThreadDoesToTheJaws) {
  struct Pull {
    double way_m;
    std::vector<std::string> overrides;
  };
  // In the second case the jaws pinch so weakly that the thread slips at 0.3 N.
  for (const auto& [way_m, overrides] : {Pull{0.004, {}}, Pull{0.02, {"hands.pinch_force_N=0.5"}}}) {
    const Played p(suture(overrides),
                   {{0.0, {0.0, 0.0, 0.20}, false},
                    {0.3, {0.0, 0.0, 0.20}, true},
                    {2.0, {0.0, 0.0, 0.20 - way_m}, true},
                    {2.5, {0.0, 0.0, 0.20 - way_m}, true}},
                   {{0.0, {0.0, 0.0, 0.06}, false},
                    {0.3, {0.0, 0.0, 0.06}, true},
                    {1.5, {0.10, 0.05, 0.17}, true},
                    {2.5, {0.10, 0.05, 0.17}, true}});
    double off_N = 0.0;
    for (std::size_t k = p.tick_at(2.2); k < p.tick_at(2.5); ++k)
      for (std::size_t h = 0; h < 2; ++h)
        off_N = std::max(off_N, apart(p.rig.records[k].f_wish_N[h], p.rig.records[k - 1].f_world_N[h]));
    std::printf("felt: within %.4f N of %.4f and %.4f N; the thread pulls by %.4f N\n", off_N,
                size(p.at(2.4).f_world_N[0]), size(p.at(2.4).f_world_N[1]), p.tension_at(2.4));
    EXPECT_LT(off_N, 0.002);
    EXPECT_NEAR(p.at(2.4).f_wish_N[0][2], p.tension_at(2.4), 0.01 * p.tension_at(2.4));
    EXPECT_LT(size(p.at(2.4).f_wish_N[1]), 0.02);  // the right hand holds the slack part of the thread
  }
}

/// The free end weighs a fifth of a millinewton. The coupling uses the end's position of the previous tick. This delay
/// acts as a drag (spring constant x period x speed) and absorbs energy; an extrapolated position would make the ports
/// deliver energy.
TEST(SutureHands, CarryAnEndThatWeighsNothing) {
  const Played p(suture(), {},
                 {{0.0, {0.0, 0.0, 0.06}, false},
                  {0.3, {0.0, 0.0, 0.06}, true},
                  {0.5, {0.0, 0.0, 0.06}, true},
                  {2.0, {0.1, 0.0, 0.16}, true},
                  {2.5, {0.1, 0.0, 0.16}, true}});
  double felt_N = 0.0, speed_m_per_s = 0.0;
  const std::size_t from = p.tick_at(1.0), to = p.tick_at(1.5);
  for (std::size_t k = from; k < to; ++k) {
    const rt::Triple &f = p.rig.records[k].f_wish_N[1], &v = p.rig.records[k].v_WT_m_per_s[1];
    felt_N -= (f[0] * v[0] + f[1] * v[1] + f[2] * v[2]) / size(v) / static_cast<double>(to - from);
    speed_m_per_s += size(v) / static_cast<double>(to - from);
  }
  std::printf("carried at %.4f m/s: a drag of %.4f N\n", speed_m_per_s, felt_N);
  EXPECT_NEAR(felt_N, kThread_N_per_m * 1e-3 * speed_m_per_s, 0.03 * felt_N);
}

/// The right hand grips above the left one and draws until it alone would hold the same tension. Then the left hand
/// lets go.
TEST(SutureHands, HandTheThreadOverUnderLoad) {
  constexpr double kClosed_s = 2.6, kBoth_s = 4.4, kOpen_s = 4.5, kWay_m = 0.0042;
  constexpr double kPlace_m = 0.1812, kLength_m = kTop_m - kPlace_m;  // between two nodes
  const Played p(suture(),
                 {{0.0, {0.0, 0.0, 0.15}, false},
                  {0.3, {0.0, 0.0, 0.15}, true},
                  {0.5, {0.0, 0.0, 0.15}, true},
                  {1.5, {0.0, 0.0, 0.143}, true},
                  {kOpen_s, {0.0, 0.0, 0.143}, false},
                  {5.5, {-0.04, 0.0, 0.143}, false}},
                 {{0.0, {0.03, 0.0, kPlace_m}, false},
                  {1.5, {0.03, 0.0, kPlace_m}, false},
                  {2.5, {0.0, 0.0, kPlace_m}, false},
                  {kClosed_s, {0.0, 0.0, kPlace_m}, true},
                  {3.0, {0.0, 0.0, kPlace_m}, true},
                  {4.0, {0.0, 0.0, kPlace_m - kWay_m}, true},
                  {5.5, {0.0, 0.0, kPlace_m - kWay_m}, true}});
  const double before_N = p.tension_at(2.5), both_N = p.tension_at(kBoth_s), after_N = p.tension_at(5.4);
  EXPECT_NEAR(before_N, pulled_N(0.007, 0.2), 0.05 * before_N);
  // When the right hand closes, its spring is at rest at the stretched thread's position.
  EXPECT_NEAR(after_N, pulled_N(kWay_m + before_N * kLength_m / kEA_N, kLength_m), 0.03 * after_N);
  const auto range = std::minmax_element(p.top_N.begin() + static_cast<std::ptrdiff_t>(p.tick_at(2.5)),
                                         p.top_N.begin() + static_cast<std::ptrdiff_t>(p.tick_at(5.4)));
  std::printf("handed over: %.3f N, %.3f with both, %.3f; never below %.3f nor above %.3f\n", before_N, both_N, after_N,
              *range.first, *range.second);
  EXPECT_GT(*range.first, 0.97 * before_N);
  EXPECT_LT(*range.second, 1.01 * both_N);
  EXPECT_LT(both_N, 1.5 * before_N);
  // The force that each hand feels before and after is the thread's tension.
  EXPECT_NEAR(size(p.at(2.5).f_device_N[0]), before_N, 0.01 * before_N);
  EXPECT_NEAR(size(p.at(5.4).f_device_N[1]), after_N, 0.01 * after_N);
  EXPECT_LT(size(p.at(2.9).f_wish_N[1]), 0.01 * before_N);  // the jaws' closing itself causes no force
  EXPECT_GT(size(p.at(kBoth_s).f_device_N[0]), kStep_N);    // this force cannot end within one step
  for (std::size_t h = 0; h < 2; ++h) EXPECT_LE(p.step_N(h), kStep_N) << h;
  EXPECT_EQ(size(p.at(kOpen_s + 0.05).f_device_N[0]), 0.0);
}

/// Beside a thread that the left hand holds taut, the right hand closes 14 mm away from it. Out of reach it holds
/// nothing; within reach it draws the thread aside by x, and the force that it feels grows gradually to T x / l from
/// either side (T tension, l length to the next hold).
TEST(SutureHands, CloseFarOffWithoutAStep) {
  constexpr double kOff_m = 0.014, kClosed_s = 2.6;
  for (const bool within : {false, true}) {
    const Played p(
        suture({within ? "hands.reach_m=0.02" : "hands.reach_m=0.01"}),
        {{0.0, {0.0, 0.0, 0.15}, false},
         {0.3, {0.0, 0.0, 0.15}, true},
         {0.5, {0.0, 0.0, 0.15}, true},
         {1.5, {0.0, 0.0, 0.144}, true},
         {4.5, {0.0, 0.0, 0.144}, true}},
        {{0.0, {kOff_m, 0.0, 0.20}, false}, {kClosed_s, {kOff_m, 0.0, 0.20}, true}, {4.5, {kOff_m, 0.0, 0.20}, true}});
    const rt::TickRecord& last = p.at(4.4);
    EXPECT_TRUE(last.grip[1]);
    EXPECT_EQ(last.grasped_node[1] >= 0, within);
    double wish_step_N = 0.0;  // largest step of the coupling's force, before gain, limits and passivity
    for (std::size_t k = p.tick_at(kClosed_s - 0.1); k < p.tick_at(4.4); ++k)
      wish_step_N = std::max(wish_step_N, apart(p.rig.records[k].f_wish_N[1], p.rig.records[k - 1].f_wish_N[1]));
    std::printf("closed 14 mm off: feels %.3f N of %.3f, in steps of %.3f N (%.3f asked); the other hand %.3f N\n",
                size(last.f_device_N[1]), size(last.f_wish_N[1]), p.step_N(1, kClosed_s - 0.1, 4.4), wish_step_N,
                p.step_N(0, kClosed_s - 0.1, 4.4));
    EXPECT_EQ(size(last.f_wish_N[1]) > 0.1, within);
    EXPECT_EQ(size(last.f_wish_N[1]) == 0.0, !within);
    EXPECT_LT(wish_step_N, 0.03);
    // The passivity controller holds back force whose energy the account does not cover yet, and later releases it by
    // 0.15 N per tick. The limit on torques in any pose (AnyPose) also changes from tick to tick, by up to an eighth.
    for (std::size_t h = 0; h < 2; ++h) EXPECT_LT(p.step_N(h, kClosed_s - 0.1, 4.4), 0.175) << h;
  }
}

/// A hand at the end of its workspace presses the clutch, moves back, and continues the pull.
TEST(SutureHands, ReachRoundWithTheClutch) {
  constexpr double kPress_s = 2.0, kRelease_s = 3.5, kLength_m = 0.2;
  sim::Vec3 hand_m[2];
  bool pressed = false;
  const auto clutch = [&](SimulatedRig& rig, double t_s) {
    const bool wanted = t_s > kPress_s && t_s < kRelease_s;
    hand_m[t_s < 2.1] = rig.left.device.mechanics().touch().p_DT;
    if (wanted == pressed) return;
    pressed = wanted;
    rig.outlets->commands.push({0, wanted ? rt::CommandKind::kClutchLeft : rt::CommandKind::kUnclutchLeft});
  };
  const Played p(suture(),
                 {{0.0, {0.0, 0.0, 0.15}, false},
                  {0.3, {0.0, 0.0, 0.15}, true},
                  {0.5, {0.0, 0.0, 0.15}, true},
                  {1.5, {0.0, 0.0, 0.1472}, true},
                  {2.2, {0.0, 0.0, 0.1472}, true},
                  {3.2, {0.03, 0.02, 0.1772}, true},
                  {5.0, {0.03, 0.02, 0.1772}, true}},
                 {}, clutch);
  const double before_N = p.tension_at(1.9), felt_N = size(p.at(1.9).f_device_N[0]);
  EXPECT_NEAR(before_N, pulled_N(0.0028, kLength_m), 0.05 * before_N);
  EXPECT_GT(felt_N, 0.2);  // passivity withholds a share in a slow pull
  EXPECT_GT((hand_m[0] - hand_m[1]).norm(), 0.04);
  for (std::size_t k = p.tick_at(kPress_s + 0.1); k + 2 < p.tick_at(kRelease_s); ++k) {
    ASSERT_EQ(p.rig.records[k].p_WT_m[0], p.at(kPress_s + 0.1).p_WT_m[0]);
    ASSERT_NEAR(p.top_N[k], before_N, 0.005 * before_N);
    ASSERT_EQ(size(p.rig.records[k].f_device_N[0]), 0.0);
  }
  // The force is back, and the hand has yielded to it.
  const double again_N = size(p.at(4.9).f_device_N[0]), after_N = p.tension_at(4.9);
  const double gave_way_N = again_N / kHand_N_per_m / (kLength_m / kEA_N + 1.0 / kDevice_N_per_m);
  std::printf("clutch: %.3f N, felt %.3f; then %.3f, felt %.3f; largest step %.3f N\n", before_N, felt_N, after_N,
              again_N, p.step_N(0, 1.9));
  EXPECT_GT(again_N, 0.7 * felt_N);
  EXPECT_NEAR(after_N, before_N - gave_way_N, 0.02 * before_N);
  EXPECT_LT(apart(p.at(4.9).p_WT_m[0], p.at(1.9).p_WT_m[0]), 5e-4);
  EXPECT_LT(p.step_N(0, 1.9), 0.05);  // the gain ramps the force down at the press and up at the release
}

}  // namespace
}  // namespace ligature
