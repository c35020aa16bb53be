// Passivity of the device ports in the whole rig: quantised positions, CAN frames, one sample of delay, adversarial
// hands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/lab/rig/port_bound.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "protocol/device/device_file.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/unrest.hpp"
#include "tests/integration/virtual_rig/scenes.hpp"
#include "tests/support/random.hpp"

namespace ligature {
namespace {

constexpr double kFloor_J = 1e-6;
constexpr double kStep_N = 0.5, kRounding_N = 0.02;  // records hold the force before its torques are rounded

scene::Scene scene_with(std::vector<std::string> overrides) {
  overrides.emplace_back("suture.nodes=12");
  return std::get<scene::Scene>(scene::load_scene(kScenes + "paper.toml", overrides));
}

/// Grips the thread's end, pulls it tight and releases it, repeatedly. With `jumps` the hand's target moves in jumps of
/// amplitude_m.
class Pulling final : public sim::Intention {
 public:
  Pulling(const sim::Vec3& at, double period_s, double amplitude_m, bool jumps)
      : at_(at), period_s_(period_s), amplitude_m_(amplitude_m), jumps_(jumps) {}
  [[nodiscard]] sim::Intent at(double t_s, const sim::Touch&) const noexcept override {
    sim::Intent now{at_, sim::Vec3::Zero(), t_s > 0.2};
    if (!(t_s > 1.0)) return now;
    const double phase = std::fmod(t_s - 1.0, period_s_) / period_s_;
    const double share = jumps_ ? (phase < 0.5 ? 1.0 : 0.0) : 0.5 - 0.5 * std::cos(2.0 * std::acos(-1.0) * phase);
    now.p_DH += amplitude_m_ * share * sim::Vec3(1.0, 0.3, -0.5);
    now.grip = now.grip && std::fmod(t_s, 1.7) < 1.6;  // releases the thread from time to time
    return now;
  }
  [[nodiscard]] double end_s() const noexcept override { return 1e9; }
  [[nodiscard]] sim::Vec3 start_D_m() const noexcept override { return at_; }

 private:
  sim::Vec3 at_;
  double period_s_, amplitude_m_;
  bool jumps_;
};

struct Outcome {
  double lowest_J = 0.0;  ///< lowest account
  /// Of the bounds of docs/passivity.md, which also hold while frames are lost: smallest difference of their two sides;
  /// lowest true work (with what the other hand lent) of the hand for which it is lowest, and its bound at that time
  double margin_J = 0.0, work_J = 0.0, bound_J = 0.0;
  double beyond_J = 0.0;  ///< largest ceiling of the term "beyond"
  double peak_N = 0.0;
  double step_N = 0.0;    ///< largest step of force, except for faults and hands that are let go
  double let_go_N = 0.0;  ///< largest step by which passivity lets a hand go (to zero)
  /// Share of the pulling time in which both hands feel at least four fifths of the coupling's force.
  double felt_share = 0.0;
  int fault = 0;
  int limits = 0;
};

Outcome outcome_of(const lab::VirtualRig& rig) {
  Outcome o;
  std::array<rt::Triple, 2> before{};
  for (const auto& r : rig.records) {
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& f = r.f_device_N[h];
      o.lowest_J = std::min(o.lowest_J, r.port_energy_J[h]);
      o.peak_N = std::max(o.peak_N, std::hypot(f[0], f[1], f[2]));
      const double step_N = std::hypot(f[0] - before[h][0], f[1] - before[h][1], f[2] - before[h][2]);
      const bool is_let_go = f == rt::Triple{} && (r.limits[h] & rt::kPassivityLimit) != 0;
      double& largest_N = is_let_go ? o.let_go_N : o.step_N;
      if (r.fault == 0) largest_N = std::max(largest_N, step_N);
      o.limits |= r.limits[h];
    }
    before = r.f_device_N;
    const auto size = [](const rt::Triple& f) { return std::hypot(f[0], f[1], f[2]); };
    const bool felt =
        size(r.f_device_N[0]) >= 0.8 * size(r.f_wish_N[0]) && size(r.f_device_N[1]) >= 0.8 * size(r.f_wish_N[1]);
    if (r.tick >= 1500) o.felt_share += felt / static_cast<double>(rig.records.size() - 1500);
    if (o.fault == 0) o.fault = r.fault;
  }
  return o;
}

struct Hands {
  std::string name;
  double tightness = 0.5;
  double period_s = 0.7, amplitude_m = 0.03;
  bool jumps = false;
  double lead_s = 0.0;  // an adversarial hand pushes this far ahead, in time, along the tip's velocity; 0: none
  double frame_loss = 0.0;
};

/// @param seed of the frame losses
Outcome play(const scene::Scene& scene, const Hands& hands, std::uint64_t seed = 1,
             const device::Device& device = device::omni()) {
  lab::RigSetup setup{.scene = scene, .device = device};
  setup.frame_loss = hands.frame_loss;
  setup.seed = seed;
  for (auto& body : setup.body) {
    body = sim::Body::of(device);
    body.hand = sim::Hand::holding(hands.tightness);
  }
  lab::VirtualRig::Intentions intentions;
  for (std::size_t h = 0; h < 2; ++h) {
    const sim::Vec3 at(device.home_tip_m[0] + (h == 0 ? -0.02 : 0.02), device.home_tip_m[1], device.home_tip_m[2]);
    intentions[h] =
        std::make_unique<Pulling>(at, hands.period_s + 0.1 * static_cast<double>(h), hands.amplitude_m, hands.jumps);
    if (hands.lead_s > 0.0)
      intentions[h] = std::make_unique<sim::Adversarial>(std::move(intentions[h]), hands.lead_s, 0.02);
  }
  lab::VirtualRig rig(setup, std::move(intentions));
  std::array<lab::PortBound, 2> ports{lab::PortBound(device, 0), lab::PortBound(device, 1)};
  rig.each_tick = [&] {
    if (rig.records.empty()) return;
    ports[0].look(rig.left.device, rig.records.back(), rig.controller.hand(0).received_J);
    ports[1].look(rig.right.device, rig.records.back(), rig.controller.hand(1).received_J);
  };
  EXPECT_EQ(rig.run(5000), std::nullopt);
  Outcome o = outcome_of(rig);
  const auto& lower = ports[ports[1].lowest_work_J() < ports[0].lowest_work_J() ? 1 : 0];
  o.margin_J = std::min(ports[0].least_margin_J(), ports[1].least_margin_J());
  o.work_J = lower.lowest_work_J(), o.bound_J = lower.its_bound_J();
  o.beyond_J = std::max(ports[0].most_beyond_J(), ports[1].most_beyond_J());
  return o;
}

/// Ten times the shipped coupling stiffness: 720 N/m at the device, which renders at most 440 N/m stably.
std::vector<std::string> stiff() { return {"hands.coupling_N_per_m=12000", "hands.override_passivity=true"}; }

TEST(PassivityRig, NoHandGetsEnergyOutOfAPort) {
  const std::vector<Hands> all{{"a calm pull and release"},
                               {"a loose hand", 0.0},
                               {"a clenched fist", 1.0, 0.4},
                               {"a hand that jumps", 0.7, 0.5, 0.03, true},
                               {"a hand that pushes on", 0.3, 0.7, 0.03, false, 0.05},
                               {"a hand that is braked", 0.24, 0.713, 0.032, false, 0.05}};
  for (const auto& overrides : {std::vector<std::string>{}, stiff()}) {
    for (const Hands& hands : all) {
      SCOPED_TRACE(hands.name);
      const Outcome o = play(scene_with(overrides), hands);
      std::printf("%-26s %s lowest %.2e J, peak %.3f N, step %.3f N, let go from %.3f N, limits %d, fault %d\n",
                  hands.name.c_str(), overrides.empty() ? "shipped" : "stiff  ", o.lowest_J, o.peak_N, o.step_N,
                  o.let_go_N, o.limits, o.fault);
      EXPECT_GE(o.lowest_J, -kFloor_J);
      EXPECT_LE(o.peak_N, 3.3);
      EXPECT_LE(o.step_N, kStep_N + kRounding_N);
      EXPECT_LE(o.let_go_N, kStep_N);
    }
  }
}

/// While frames are lost, the floor of -1 uJ is no theorem: the lowest account of 320 runs was -900 uJ
/// (docs/measurements/haptics.md). The bounds of docs/passivity.md are, for every draw of the losses. A hand may then
/// be let go from any force.
TEST(PassivityRig, LostFramesGiveNoMoreThanThePageAllows) {
  test::Random random(63);
  const std::vector<Hands> all{{"a calm pull and release", 0.5, 0.7},
                               {"a loose hand", 0.0},
                               {"a clenched fist", 1.0, 0.4},
                               {"a hand that jumps", 0.7, 0.5, 0.03, true}};
  for (const auto& overrides : {std::vector<std::string>{}, stiff()}) {
    for (Hands hands : all) {
      for (int k = 0; k < 3; ++k) {
        hands.frame_loss = random.in(0.01, 0.1);
        const std::uint64_t seed = random();
        SCOPED_TRACE(testing::Message() << hands.name << ", seed " << seed);
        const Outcome o = play(scene_with(overrides), hands, seed);
        std::printf(
            "%-24s %s %4.1f %% lost: account %.1e J; work %.1e J where %.1e J is allowed; beyond up to %.1e J, "
            "margin %.1e J, fault %d\n",
            hands.name.c_str(), overrides.empty() ? "shipped" : "stiff  ", 100.0 * hands.frame_loss, o.lowest_J,
            o.work_J, o.bound_J, o.beyond_J, o.margin_J, o.fault);
        EXPECT_GE(o.margin_J, 0.0);
        EXPECT_LE(o.peak_N, 3.3);
        EXPECT_LE(o.step_N, kStep_N + kRounding_N);
      }
    }
  }
}

TEST(PassivityRig, ThroughLostFramesAPullIsFelt) {
  test::Random random(64);
  const Hands hands{"", 0.5, 0.7, 0.03, false, 0.0, 0.0};
  for (const double lost : {0.0, 0.01, 0.05, 0.05, 0.05}) {
    Hands lossy = hands;
    lossy.frame_loss = lost;
    const Outcome o = play(scene_with({}), lossy, random());
    std::printf("%.2f of the frames lost: felt in %.3f of the time, lowest %.2e J\n", lost, o.felt_share, o.lowest_J);
    EXPECT_GT(o.felt_share, 0.9);
    EXPECT_GE(o.margin_J, 0.0);
  }
}

TEST(PassivityRig, WithoutTheControllerOneOfThemIsAMotor) {
  auto overrides = stiff();
  overrides.emplace_back("hands.passivity=false");
  const Hands hands{"a hand that pushes on", 0.0, 0.7, 0.03, false, 0.05};
  const Outcome free = play(scene_with(overrides), hands), held = play(scene_with(stiff()), hands);
  std::printf("without: lowest %.2e J, fault %d; with: lowest %.2e J\n", free.lowest_J, free.fault, held.lowest_J);
  EXPECT_LT(free.lowest_J, -1e-3);
  EXPECT_GE(held.lowest_J, -kFloor_J);
}

TEST(PassivityRig, AnotherDeviceIsAFile) {  // a Cartesian device instead of an arm, with the same CAN messages
  const auto device = std::get<device::Device>(device::load_device(kScenes + "devices/cartesian.toml"));
  const Outcome o = play(scene_with({}), {"a calm pull and release"}, 1, device);
  EXPECT_EQ(o.fault, 0);
  EXPECT_GT(o.peak_N, 0.01);
  EXPECT_GE(o.lowest_J, -kFloor_J);
}

}  // namespace
}  // namespace ligature
