// Park and calibrate: the controller moves simulated arms by itself, with encoders that may be wrong from the start.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "firmware/control/controller.hpp"

namespace ligature::control {
namespace {

/// Two arms with the Omni's inertia and friction, held by hands that only press the dead-man; samples are one tick old.
class Arms {
 public:
  explicit Arms(const JointAngles& at = {0.3, 0.6, 0.4}) : controller(scene(), {20, true}) {
    q.fill(vector_of(at));
    for (auto& r : in.reading.hand) r.valid = r.enabled = r.dead_man = true;
  }
  static scene::Hands scene() {
    scene::Hands hands;
    hands.workspace_scale = 1.0;
    hands.force_scale = 1.0;
    return hands;
  }

  void tick() {
    const double count = device::omni().rad_per_count();
    for (std::size_t h = 0; h < 2; ++h) {
      for (std::size_t j = 0; j < 3; ++j) {
        const auto i = static_cast<Eigen::Index>(j);
        const double seen = h == 0 && frozen == static_cast<int>(j) ? first[i] : q[h][i];
        in.reading.hand[h].q_rad[j] =
            (h == 0 && reversed == static_cast<int>(j) ? -1.0 : 1.0) * std::round(seen / count) * count;
      }
    }
    auto now = in;
    for (auto& hand : now.reading.hand) hand.dead_man = hand.dead_man && released >= DeadMan::kReleased;
    if (released < DeadMan::kReleased) ++released;  // ticks since the release; an earlier press does not count
    const auto command = controller.tick(now);
    ++in.tick;
    for (std::size_t h = 0; h < 2; ++h) {
      const Vec3 tip = linkage.position({q[h][0], q[h][1], q[h][2]});
      move(q[h], omega[h], acting[h], work_J[h]);
      speed = std::max(speed, (linkage.position({q[h][0], q[h][1], q[h][2]}) - tip).norm() / 1e-3);
      acting[h] = vector_of(command.hand[h].torque_Nm);
      most_N = std::max(most_N, controller.hand(h).f_device_N.norm());
      most_J = std::max(most_J, work_J[h]);
      // Energy lent to the port for the move, minus the energy that its motors have delivered.
      least_bound_J = std::min(least_bound_J, controller.hand(h).received_J - work_J[h]);
    }
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) tick();
  }
  void to_force() {
    first = q[0];
    ticks(1000);
    ASSERT_EQ(controller.state(), State::kForce);
  }
  [[nodiscard]] Vec3 tip(std::size_t h) const { return linkage.position({q[h][0], q[h][1], q[h][2]}); }

  Controller controller;
  TickInput in;
  Linkage linkage{device::omni()};
  std::array<Vec3, 2> q{}, omega{Vec3(0, 0, 0), Vec3(0, 0, 0)}, acting{Vec3(0, 0, 0), Vec3(0, 0, 0)};
  std::array<double, 2> work_J{};
  Vec3 first = Vec3::Zero();
  double most_N = 0.0, most_J = 0.0, speed = 0.0, least_bound_J = 0.0;
  int reversed = -1, frozen = -1;  // joint of the left hand whose encoder counts backwards; or stands still. -1: none
  int released = 0;
  bool held = false;  // both arms are held fast

 private:
  void move(Vec3& angle, Vec3& rate, const Vec3& torque, double& work) const {
    const Vec3 inertia(1.3e-3, 8.1e-4, 7.9e-4), viscous(8.7e-3, 5.4e-3, 5.3e-3), dry(0.017, 0.0134, 0.0133);
    if (held) return;
    for (int i = 0; i < 10; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) {
        const double free = (rate[j] + 1e-4 / inertia[j] * torque[j]) / (1.0 + 1e-4 / inertia[j] * viscous[j]);
        rate[j] = std::copysign(std::max(0.0, std::abs(free) - 1e-4 / inertia[j] * dry[j]), free);
        angle[j] += 1e-4 * rate[j];
        work += torque[j] * 1e-4 * rate[j];
      }
    }
  }
};

constexpr double kSlack = 1.0 + 1e-9;

TEST(LedMove, ParkLeadsBothHandsGentlyToTheRestingPose) {
  Arms arms;
  arms.to_force();
  arms.controller.command(rt::CommandKind::kPark);
  arms.ticks(6000);
  const auto& d = device::omni();
  const Vec3 park(0.5 * (d.workspace_min_m[0] + d.workspace_max_m[0]), d.home_tip_m[1], d.workspace_min_m[2] + 0.01);
  for (std::size_t h = 0; h < 2; ++h) EXPECT_LT((arms.tip(h) - park).norm(), 0.005) << h;
  EXPECT_EQ(arms.controller.fault(), Fault::kNone);
  EXPECT_LE(arms.most_N, HandControl::kLead_N * kSlack);
  EXPECT_LT(arms.speed, 0.25);
  EXPECT_LE(arms.most_J, HandControl::kLeadEnergy_J);
  EXPECT_GE(arms.least_bound_J, -1e-6);
  EXPECT_GT(arms.controller.hand(0).received_J, 0.0);
  EXPECT_LT(arms.controller.hand(0).received_J, HandControl::kLeadEnergy_J);
  // Unused energy that was lent for the move has been returned.
  EXPECT_LT(std::abs(arms.controller.hand(0).port_energy_J), 1e-6);
}

TEST(LedMove, NothingIsGrippedOnTheWay) {
  Arms arms;
  arms.to_force();
  arms.in.reading.hand[0].grip = true;
  arms.controller.command(rt::CommandKind::kPark);
  arms.ticks(500);
  EXPECT_FALSE(arms.controller.tools()[0].grip);
  arms.ticks(6000);
  EXPECT_TRUE(arms.controller.tools()[0].grip);
}

TEST(LedMove, CalibrateLeadsHome) {
  Arms arms;
  arms.to_force();
  arms.controller.command(rt::CommandKind::kCalibrate);
  arms.ticks(6000);
  EXPECT_LT((arms.tip(0) - arms.linkage.home_m()).norm(), 0.005);
  EXPECT_EQ(arms.controller.fault(), Fault::kNone);
}

TEST(LedMove, CalibrateUndoesTheClutchsOffset) {
  Arms arms;
  arms.to_force();
  arms.in.reading.hand[0].clutch = true;
  arms.ticks(100);
  for (int i = 0; i < 200; ++i, arms.tick()) arms.q[0].x() += 0.0015;  // the hand moves on, its tool stays (clutch)
  arms.in.reading.hand[0].clutch = false;
  arms.ticks(1000);
  const auto off_m = [&] { return (arms.controller.hand(0).p_WT - (arms.tip(0) - arms.linkage.home_m())).norm(); };
  ASSERT_GT(off_m(), 0.02);
  arms.controller.command(rt::CommandKind::kCalibrate);
  arms.ticks(6000);
  EXPECT_LT((arms.tip(0) - arms.linkage.home_m()).norm(), 0.005);
  EXPECT_LT(off_m(), 1e-4);
}

TEST(LedMove, CalibrateGoesToTheOriginOfThePresentScene) {
  Arms arms;
  arms.ticks(60);
  auto hands = Arms::scene();
  hands.workspace_origin_m = {0.5, 0.0, 0.0};
  arms.controller.change_hands(hands);
  arms.to_force();
  arms.controller.command(rt::CommandKind::kCalibrate);
  arms.ticks(6000);
  const Vec3 tool_m = Vec3(0.5, 0.0, 0.0) + arms.tip(0) - arms.linkage.home_m();
  EXPECT_LT((arms.controller.hand(0).p_WT - tool_m).norm(), 1e-4);
}

TEST(LedMove, NothingMovesWithoutACommandADeadManOrArming) {
  for (const int without : {0, 1, 2}) {
    Arms arms;
    arms.to_force();
    const Vec3 before = arms.q[0];
    if (without == 1) {
      for (auto& r : arms.in.reading.hand) r.dead_man = false;
    }
    if (without == 2) arms.controller.command(rt::CommandKind::kDisarm);
    arms.ticks(100);
    if (without != 0) arms.controller.command(rt::CommandKind::kPark);
    for (auto& r : arms.in.reading.hand) r.dead_man = true;  // too late: the command has ended
    arms.ticks(2000);
    EXPECT_EQ(arms.q[0], before) << without;
  }
}

TEST(LedMove, LettingGoOfTheDeadManEndsIt) {
  Arms arms;
  arms.to_force();
  arms.controller.command(rt::CommandKind::kPark);
  arms.ticks(500);
  ASSERT_GT(arms.most_N, 0.05);
  arms.in.reading.hand[0].dead_man = false;
  arms.ticks(Engagement::kFallTicks + 3);
  EXPECT_EQ(arms.controller.hand(0).f_device_N.norm(), 0.0);
  arms.in.reading.hand[0].dead_man = true;
  const Vec3 there = arms.q[0];
  arms.ticks(2000);
  EXPECT_LT((arms.q[0] - there).norm(), 1e-2);  // the arm coasts at most
}

TEST(LedMove, AHandThatHoldsTheThreadIsNotLed) {
  Arms arms;
  arms.to_force();
  for (std::size_t h = 0; h < 2; ++h) arms.in.grasp[h] = {true, arms.controller.hand(h).p_WT, Vec3::Zero()};
  arms.tick();
  const Vec3 before = arms.q[0];
  arms.controller.command(rt::CommandKind::kPark);
  arms.ticks(1000);
  EXPECT_LT((arms.q[0] - before).norm(), 1e-3);
}

TEST(LedMove, TakingTheThreadOrTheClutchEndsItForGood) {
  for (const bool clutch : {false, true}) {
    Arms arms;
    arms.to_force();
    arms.controller.command(rt::CommandKind::kPark);
    arms.ticks(400);
    ASSERT_GT(arms.most_N, 0.05);
    arms.in.grasp[0] = {!clutch, arms.controller.hand(0).p_WT, Vec3::Zero()};
    arms.in.reading.hand[0].clutch = clutch;
    arms.ticks(100);
    arms.in.grasp[0].held = arms.in.reading.hand[0].clutch = false;
    arms.ticks(50);
    const Vec3 there = arms.q[0];
    arms.ticks(2000);
    EXPECT_LT((arms.q[0] - there).norm(), 1e-3) << clutch;
  }
}

/// A rejected move changes nothing: a held thread stays held, and every torque is as if the command had not come.
TEST(LedMove, AMoveThatIsRefusedIsAsIfNobodyHadAskedForIt) {
  struct Reason {
    const char* name;
    State state;  // the controller's state 5 ticks before the command
    void (*forbid)(Arms&);
  };
  const std::vector<Reason> reasons{
      {"not up yet", State::kCalibrate, [](Arms&) {}},
      {"disarmed", State::kBrake, [](Arms& a) { a.controller.command(rt::CommandKind::kDisarm); }},
      {"a fault", State::kFault, [](Arms& a) { a.in.reading.hand[0].drive_fault = true; }},
      {"no dead-man", State::kForce,
       [](Arms& a) {
         for (auto& r : a.in.reading.hand) r.dead_man = false;
       }},
      {"the thread", State::kForce, [](Arms& a) { a.in.grasp[0].held = a.in.grasp[1].held = true; }},
      {"the clutch", State::kForce,
       [](Arms& a) {
         for (auto& r : a.in.reading.hand) r.clutch = true;
       }},
      {"too fast", State::kBrake, [](Arms& a) { a.omega[0].x() = a.omega[1].x() = 14.0; }}};
  for (const auto& reason : reasons) {
    SCOPED_TRACE(reason.name);
    Arms asked, other;
    for (Arms* arms : {&asked, &other}) {
      arms->ticks(reason.state == State::kCalibrate ? 20 : 1000);
      for (std::size_t h = 0; h < 2; ++h) {
        arms->in.reading.hand[h].grip = true;
        arms->in.grasp[h].p_WG = arms->controller.hand(h).p_WT + Vec3(0, 0, 1e-3);
      }
      reason.forbid(*arms);
      arms->ticks(5);
    }
    ASSERT_EQ(asked.controller.state(), reason.state);
    asked.controller.command(rt::CommandKind::kPark);
    for (int i = 0; i < 400; ++i) {
      asked.tick(), other.tick();
      ASSERT_EQ(asked.acting, other.acting) << i;
      for (std::size_t h = 0; h < 2; ++h)
        ASSERT_EQ(asked.controller.tools()[h].grip, other.controller.tools()[h].grip) << i;
    }
  }
}

/// The command for a move arrives while the gain still rises. Before the gain is full, a condition of the move ends
/// (e.g. the dead-man is released): then a later press must not start the move.
TEST(LedMove, OneThatHasNotBegunIsOverForGood) {
  using Set = void (*)(Arms&, bool);
  const std::vector<std::pair<const char*, Set>> ends{
      {"nothing", [](Arms&, bool) {}},
      {"the dead-man", [](Arms& a, bool on) { a.in.reading.hand[0].dead_man = !on; }},
      {"the clutch", [](Arms& a, bool on) { a.in.reading.hand[0].clutch = on; }},
      {"the thread", [](Arms& a, bool on) {
         a.in.grasp[0] = {on, a.controller.hand(0).p_WT, Vec3::Zero()};
       }}};
  for (const auto& [name, set] : ends) {
    for (const bool before : {true, false}) {
      SCOPED_TRACE(::testing::Message() << name << (before ? " before it" : " after it"));
      Arms arms;
      for (int i = 0; i < 1000 && arms.controller.hand(0).gain < 0.2; ++i) arms.tick();
      if (before) set(arms, true), arms.ticks(5);
      arms.controller.command(rt::CommandKind::kPark);
      arms.ticks(5);
      ASSERT_LT(arms.controller.hand(0).gain, 1.0);
      set(arms, true), arms.ticks(20);
      set(arms, false);
      const Vec3 there = arms.q[0];
      arms.ticks(1500);
      EXPECT_EQ(arms.controller.hand(0).gain, 1.0);
      EXPECT_EQ((arms.q[0] - there).norm() > 1e-2, std::string(name) == "nothing") << (arms.q[0] - there).norm();
    }
  }
}

/// A drive reports once that it delivered far more energy than allowed. This is no fault, but it ends the move.
TEST(LedMove, OneThatCannotBePaidForIsOverAtOnce) {
  Arms arms;
  arms.to_force();
  arms.in.reading.hand[0].grip = true;
  arms.controller.command(rt::CommandKind::kPark);
  arms.ticks(400);
  ASSERT_GT(arms.controller.hand(0).f_device_N.norm(), 0.05);
  ASSERT_FALSE(arms.controller.tools()[0].grip);
  for (std::size_t j = 0; j < 3; ++j)
    arms.in.reading.hand[0].torque_Nm[j] = std::copysign(300.0, arms.omega[0][static_cast<Eigen::Index>(j)]);
  arms.tick();
  for (double& torque : arms.in.reading.hand[0].torque_Nm) torque = rt::HandReading::kNotTold;
  EXPECT_EQ(arms.controller.hand(0).f_device_N.norm(), 0.0);
  arms.tick();
  EXPECT_TRUE(arms.controller.tools()[0].grip) << "it is still led";
  const Vec3 there = arms.q[0];
  arms.ticks(2000);
  EXPECT_EQ(arms.controller.fault(), Fault::kNone);
  EXPECT_LT((arms.q[0] - there).norm(), 1e-2) << "it coasts at most";
}

/// A stop or a fault cancels the move: the next arming is for force, not for a motion by the controller.
TEST(LedMove, IsNotTakenUpAgainAfterAStopOrAFault) {
  for (const bool stop : {true, false}) {
    for (const bool begun : {true, false}) {
      Arms arms;
      for (int i = 0; i < 1000 && (begun || arms.controller.hand(0).gain < 0.2); ++i) arms.tick();
      arms.controller.command(rt::CommandKind::kPark);
      arms.ticks(begun ? 500 : 5);
      ASSERT_EQ(arms.most_N > 0.05, begun);
      if (stop) arms.controller.command(rt::CommandKind::kStop);
      arms.in.reading.hand[0].drive_fault = !stop;
      arms.ticks(100);
      arms.in.reading.hand[0].drive_fault = false;
      if (!stop) arms.controller.command(rt::CommandKind::kResetFault);
      arms.ticks(100);
      arms.released = 0;  // a new press before arming
      arms.ticks(10);
      const Vec3 there = arms.q[0];
      arms.controller.command(rt::CommandKind::kArm);
      arms.ticks(2000);
      EXPECT_EQ(arms.controller.hand(0).gain, 1.0);
      EXPECT_LT((arms.q[0] - there).norm(), 1e-3) << stop << begun;
    }
  }
}

TEST(LedMove, AHandThatHoldsOnEndsItWithoutAFault) {
  Arms arms;
  arms.to_force();
  arms.held = true;
  arms.controller.command(rt::CommandKind::kCalibrate);
  arms.ticks(1000);
  EXPECT_EQ(arms.controller.fault(), Fault::kNone);
  EXPECT_GT(arms.most_N, 0.3);
  EXPECT_LE(arms.most_N, HandControl::kLead_N * kSlack);
  EXPECT_EQ(arms.controller.hand(0).f_device_N.norm(), 0.0);
}

TEST(LedMove, CalibrateFindsAnEncoderThatLiedFromTheStart) {
  for (const auto expected : {Fault::kAxisReversed, Fault::kEncoderFrozen}) {
    for (int joint = 0; joint < 3; ++joint) {
      Arms arms;
      (expected == Fault::kAxisReversed ? arms.reversed : arms.frozen) = joint;
      // With a reversed shoulder or elbow the angles are an impossible pose, so force never begins (test
      // AReversedShoulderNeverComesUp).
      if (expected == Fault::kAxisReversed && joint > 0) continue;
      arms.to_force();
      arms.controller.command(rt::CommandKind::kCalibrate);
      arms.ticks(3000);
      EXPECT_EQ(arms.controller.fault(), expected) << joint;
      EXPECT_LE(arms.most_J, HandControl::kLeadEnergy_J) << joint;
      EXPECT_LT(arms.speed, 2.0) << joint;
      EXPECT_EQ(arms.controller.hand(0).f_device_N.norm(), 0.0);
      arms.controller.command(rt::CommandKind::kResetFault);  // reported once, not again after the reset
      arms.ticks(200);
      EXPECT_EQ(arms.controller.fault(), Fault::kNone);
    }
  }
}

TEST(LedMove, AReversedShoulderNeverComesUp) {  // the reversed angles are a pose that the arm cannot reach
  Arms arms;
  arms.reversed = 1;
  arms.ticks(2000);
  EXPECT_EQ(arms.controller.state(), State::kCalibrate);
  EXPECT_EQ(arms.most_N, 0.0);
}

}  // namespace
}  // namespace ligature::control
