// AnyPose: the largest tip force that given joint torques can make in any pose of the arm. A force limit based on it
// holds even if encoders are wrong.
#include "firmware/control/any_pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/unit/control/controller_rig.hpp"

namespace ligature::control {
namespace {

constexpr double kPeak_N = 3.3, kStep_N = 0.53;
// Rounding of torques to 1/1000 of the rated torque, as a force at the pose with the shortest levers.
constexpr double kQuanta_N = 0.02;

/// Random poses of an Omni with the tip in its workspace box.
class Poses {
 public:
  explicit Poses(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return random_.in(low, high); }
  Vec3 direction() {
    const auto n = [&] { return random_.normal(); };
    return Vec3{n(), n(), n()}.normalized();
  }
  /// A random pose, by intersecting two circles (inverse kinematics). In one pose of eight the tip is at a corner of
  /// the box.
  JointAngles next() {
    const device::Device d = device::omni();
    for (;;) {
      Vec3 p;
      const bool corner = between(0.0, 8.0) < 1.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double low = d.workspace_min_m[i], high = d.workspace_max_m[i];
        p[static_cast<Eigen::Index>(i)] = corner ? (between(0.0, 1.0) < 0.5 ? low : high) : between(low, high);
      }
      const double l1 = d.links_m[0], l2 = d.links_m[1], rho = std::hypot(p.x(), p.y()), far = std::hypot(rho, p.z());
      const double q2 = std::atan2(p.z(), rho) + std::acos((l1 * l1 + far * far - l2 * l2) / (2.0 * l1 * far));
      const double q3 = std::atan2(rho - l1 * std::cos(q2), l1 * std::sin(q2) - p.z());
      const JointAngles q{std::atan2(p.x(), -p.y()), q2, q3};
      if (linkage_.is_plausible(q)) return q;
    }
  }
  [[nodiscard]] double force_N(const JointAngles& q, const Vec3& torque_Nm) const {
    return (linkage_.jacobian(q).transpose().inverse() * torque_Nm).norm();
  }
  [[nodiscard]] const Linkage& linkage() const { return linkage_; }

 private:
  test::Random random_;
  Linkage linkage_{device::omni()};
};

TEST(AnyPose, BoundsTheForceInEveryPoseAndNotByMuch) {
  const AnyPose any(device::omni());
  Poses poses(1U);
  std::vector<JointAngles> all;
  for (int i = 0; i < 2000; ++i) all.push_back(poses.next());
  for (int i = 0; i < 200; ++i) {
    const Vec3 torque_Nm = 0.3 * poses.direction();
    double most_N = 0.0;
    for (const auto& q : all) most_N = std::max(most_N, poses.force_N(q, torque_Nm));
    ASSERT_LE(most_N, any.most_N(torque_Nm) * (1.0 + 1e-9)) << torque_Nm.transpose();
    ASSERT_GE(most_N, any.most_N(torque_Nm) * 0.9) << torque_Nm.transpose();
  }
}

TEST(AnyPose, BoundsEveryMixtureOfTwoTorques) {
  const AnyPose any(device::omni());
  Poses poses(2U);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 one = 0.3 * poses.direction(), other = 0.3 * poses.direction();
    const Vec3 low = one.cwiseMin(other), high = one.cwiseMax(other);
    const Vec3 mixed(poses.between(low[0], high[0]), poses.between(low[1], high[1]), poses.between(low[2], high[2]));
    ASSERT_LE(any.most_N(mixed), any.most_N(low, high) * (1.0 + 1e-12));
  }
}

TEST(AnyPose, OfThreeDrumsIsTheForceItself) {
  device::Device d = device::omni();
  d.kinematics = device::Kinematics::kCartesian;
  d.links_m = {0.02, 0.03, 0.05};
  EXPECT_NEAR(AnyPose(d).most_N(Vec3(0.02 * 1.0, 0.03 * -2.0, 0.05 * 2.0)), 3.0, 1e-12);
}

// The workspace box contains a singular pose: the bound is finite, but so large that no force is allowed.
TEST(AnyPose, AnArmThatMayBeStretchedGetsNoForce) {
  device::Device d = device::omni();
  d.workspace_min_m[1] = -0.30;
  const double most_N = AnyPose(d).most_N(Vec3(0.0, 0.1, -0.1));
  EXPECT_TRUE(std::isfinite(most_N));
  EXPECT_GT(most_N, 100.0);
}

/// AnyPose limits the torques so that the tip's force is safe in whatever pose the arm really is, since encoders may be
/// wrong. When the encoders are right, this limit costs force. The force that remains is tested over poses and
/// directions.
TEST(AnyPose, LeavesAnHonestHandMostOfTheForce) {
  const AnyPose any(device::omni());
  Poses poses(3U);
  std::vector<double> left_N;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 torque_Nm = poses.linkage().torque(poses.next(), poses.direction());
    left_N.push_back(std::min(kPeak_N, kPeak_N / any.most_N(torque_Nm)));
  }
  std::ranges::sort(left_N);
  const Linkage& arm = poses.linkage();
  const JointAngles home{0.0, 0.872254, 0.684952};
  const auto at_home = [&](const Vec3& f) { return kPeak_N / any.most_N(arm.torque(home, f)); };
  std::printf(
      "honest force: least %.2f N, 5 %% below %.2f N, median %.2f N; home: side %.2f, in and out %.2f, up %.2f N\n",
      left_N.front(), left_N[1000], left_N[10'000], at_home(Vec3::UnitX()), at_home(Vec3::UnitY()),
      at_home(Vec3::UnitZ()));
  EXPECT_GT(left_N.front(), 1.35);  // everywhere above the continuous limit of 0.88 N
  EXPECT_GT(left_N[10'000], 2.4);
}

/// Encoder readings of a smooth motion of all joints between random poses.
class Says {
 public:
  explicit Says(Poses& poses) : poses_(poses), from_(vector_of(poses.next())), to_(from_) {}
  JointAngles at(int tick) {
    constexpr int kMove = 250;
    if (tick % kMove == 0) {
      from_ = to_;
      do to_ = vector_of(poses_.next());
      while ((to_ - from_).cwiseAbs().minCoeff() < 0.02);  // every joint moves
    }
    const double share = 0.5 - 0.5 * std::cos(std::acos(-1.0) * (tick % kMove) / kMove);
    const Vec3 q = from_ + share * (to_ - from_);
    return {q[0], q[1], q[2]};
  }

 private:
  Poses& poses_;
  Vec3 from_, to_;
};

struct Most {
  double true_N = 0.0, true_step_N = 0.0, said_N = 0.0;
};

/// Largest force and force step at the tip during strong pulls, evaluated in a hundred poses that differ from the pose
/// that the encoders report.
Most pulled_by_what_encoders_say(unsigned seed) {
  Poses poses(seed);
  Says says(poses);
  auto hands = Rig::scene();
  hands.passivity = false;
  Rig rig(hands);
  const JointAngles start = says.at(1);
  for (auto& hand : rig.in.reading.hand) hand.q_rad = start;
  rig.to_force();
  std::vector<Mat3> to_tip;
  for (int i = 0; i < 100; ++i) to_tip.push_back(poses.linkage().jacobian(poses.next()).transpose().inverse());
  Vec3 pull_m = Vec3::Zero(), before_Nm = vector_of(rig.tick().hand[0].torque_Nm);
  Most most;
  for (int tick = 0; tick < 3000; ++tick) {
    if (tick % 50 == 0) pull_m = 50.0 * poses.direction();
    rig.in.reading.hand[0].q_rad = says.at(tick);
    for (std::size_t h = 0; h < rt::kHands; ++h) rig.in.grasp[h].p_WG = rig.controller.hand(h).p_WT + pull_m;
    const Vec3 torque_Nm = vector_of(rig.tick_as_is().hand[0].torque_Nm);
    EXPECT_EQ(rig.controller.fault(), Fault::kNone) << tick;
    most.said_N = std::max(most.said_N, rig.controller.hand(0).f_device_N.norm());
    for (const Mat3& J : to_tip) {
      most.true_N = std::max(most.true_N, (J * torque_Nm).norm());
      most.true_step_N = std::max(most.true_step_N, (J * (torque_Nm - before_Nm)).norm());
    }
    before_Nm = torque_Nm;
  }
  return most;
}

TEST(LyingEncoders, NeverGetTheTrueForceOrItsStepOverTheLimit) {
  for (unsigned run = 0; run < 6; ++run) {
    const unsigned seed = 10U + run;
    const Most most = pulled_by_what_encoders_say(seed);
    std::printf("seed %u: true force at most %.3f N (said: %.3f N), true step %.3f N\n", seed, most.true_N, most.said_N,
                most.true_step_N);
    EXPECT_GT(most.said_N, 2.0);
    EXPECT_LE(most.true_N, kPeak_N + kQuanta_N);
    EXPECT_LE(most.true_step_N, kStep_N);
  }
}

}  // namespace
}  // namespace ligature::control
