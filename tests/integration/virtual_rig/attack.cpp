#include "tests/integration/virtual_rig/attack.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/unrest.hpp"
#include "tests/support/random.hpp"

namespace ligature {
namespace {

const std::string kScene = std::string(LIGATURE_SOURCE_DIR) + "/scenes/paper.toml";
constexpr double kShippedCoupling_N_per_m = 1200.0;
constexpr int kStranger = 5;  // bus client number of a foreign node
constexpr std::size_t kStrangersQueue = 16;

/// A hand that grips the thread, pulls it tight and releases it, within the workspace box.
class Pulling final : public sim::Intention {
 public:
  Pulling(const AttackPlan& plan, std::size_t hand)
      : at_(hand == 0 ? -0.03 : 0.03, -0.195, 0.0),
        along_(plan.along[hand]),
        period_s_(plan.period_s[hand]),
        amplitude_m_(plan.amplitude_m[hand]),
        end_s_(plan.let_go_s - sim::kDeadManAfterScript_s),
        jumps_(plan.jumps) {}
  [[nodiscard]] sim::Intent at(double t_s, const sim::Touch&) const noexcept override {
    sim::Intent now{at_, sim::Vec3::Zero(), t_s > 0.15};
    if (!(t_s > 0.75)) return now;
    const double phase = std::fmod(t_s - 0.75, period_s_) / period_s_;
    const double share = jumps_ ? (phase < 0.5 ? 1.0 : 0.0) : 0.5 - 0.5 * std::cos(2.0 * std::acos(-1.0) * phase);
    now.p_DH += amplitude_m_ * share * along_;
    now.grip = now.grip && std::fmod(t_s, 1.7) < 1.6;
    return now;
  }
  [[nodiscard]] double end_s() const noexcept override { return end_s_; }
  [[nodiscard]] sim::Vec3 start_D_m() const noexcept override { return at_; }

 private:
  sim::Vec3 at_, along_;
  double period_s_, amplitude_m_, end_s_;
  bool jumps_;
};

scene::Scene scene_of(const AttackPlan& plan) {
  std::vector<std::string> overrides{"suture.nodes=12", "hands.energy_credit_J=0.02", "hands.override_passivity=true"};
  overrides.push_back("hands.coupling_N_per_m=" + std::to_string(plan.coupling * kShippedCoupling_N_per_m));
  return std::get<scene::Scene>(scene::load_scene(kScene, overrides));
}

lab::RigSetup setup_of(const AttackPlan& plan) {
  lab::RigSetup setup{.scene = scene_of(plan)};
  setup.frame_loss = plan.frame_loss;
  setup.seed = test::Random(plan.seed)();
  for (std::size_t h = 0; h < 2; ++h) setup.body[h].hand = sim::Hand::holding(plan.tightness[h]);
  return setup;
}

lab::VirtualRig::Intentions hands_of(const AttackPlan& plan) {
  lab::VirtualRig::Intentions hands;
  for (std::size_t h = 0; h < 2; ++h) {
    hands[h] = std::make_unique<Pulling>(plan, h);
    if (plan.lead_s > 0.0) hands[h] = std::make_unique<sim::Adversarial>(std::move(hands[h]), plan.lead_s, 0.02);
  }
  return hands;
}

std::uint8_t byte(std::int64_t value) { return static_cast<std::uint8_t>(value & 0xFF); }

}  // namespace

AttackPlan::AttackPlan(std::uint64_t s) : seed(s) {
  test::Random random(s * 0x9E3779B97F4A7C15ULL + 1);
  choose_hands(random);
  choose_faults(random);
  choose_foreign(random);
  choose_orders(random);
}

AttackPlan::Foreign AttackPlan::flood(int hand, std::int64_t from, std::int64_t ticks, int a_tick) {
  return {hand, from, ticks, a_tick, {0x001U, 8, {}}, "flood"};
}

AttackPlan AttackPlan::pulls(std::uint64_t seed) {
  AttackPlan plan(seed);
  plan.coupling = 10.0;
  plan.let_go_s = 1e9;
  plan.lead_s = plan.frame_loss = 0.0;
  plan.faults = {};
  plan.foreign.clear();
  plan.orders.clear();
  plan.swap_at = plan.cut_at = plan.stall_at = -1;
  return plan;
}

void AttackPlan::choose_hands(test::Random& random) {
  coupling = std::array{1.0, 3.0, 10.0, 30.0}[static_cast<std::size_t>(random.any(0, 3))];
  for (std::size_t h = 0; h < 2; ++h) {
    tightness[h] = random.in(0.2, 1.0);
    period_s[h] = random.in(0.3, 1.2);
    amplitude_m[h] = random.in(0.01, 0.03);
    sim::Vec3 v{random.in(-1.0, 1.0), random.in(-1.0, 1.0), random.in(-1.0, 1.0)};
    along[h] = v.norm() > 1e-3 ? sim::Vec3(v.normalized()) : sim::Vec3::UnitX();
  }
  jumps = random.happens(0.3);
  if (random.happens(0.1)) lead_s = 0.05;
  if (random.happens(0.3)) let_go_s = random.in(1.05, 2.0);
}

void AttackPlan::choose_faults(test::Random& random) {
  if (random.happens(0.3)) frame_loss = random.in(0.0, 0.2);
  for (std::size_t h = 0; h < 2; ++h) {
    if (!random.happens(0.4)) continue;
    scene::FaultScript f;
    // About half of the kinds are encoder faults.
    constexpr std::array kKinds{scene::FaultKind::kLose,    scene::FaultKind::kDelay,     scene::FaultKind::kDuplicate,
                                scene::FaultKind::kReorder, scene::FaultKind::kCorrupt,   scene::FaultKind::kReboot,
                                scene::FaultKind::kButton,  scene::FaultKind::kEmergency, scene::FaultKind::kFreeze,
                                scene::FaultKind::kFreeze,  scene::FaultKind::kReverse,   scene::FaultKind::kReverse,
                                scene::FaultKind::kReverse, scene::FaultKind::kJump,      scene::FaultKind::kJump,
                                scene::FaultKind::kFreeze};
    f.kind = kKinds[static_cast<std::size_t>(random.any(0, kKinds.size() - 1))];
    f.hand = static_cast<int>(h);
    f.node = static_cast<int>(random.any(1, 3));
    f.share = random.happens(0.5) ? 1.0 : random.in(0.0, 0.2);
    f.from_s = random.in(0.8, 2.0);
    if (random.happens(0.3)) f.until_s = f.from_s + random.in(0.001, 0.1);
    f.delay_s = random.in(0.0005, 0.01);
    f.counts = static_cast<int>(random.any(-60, 60));
    if (random.happens(0.2)) f.counts *= 100;
    f.seed = static_cast<int>(random.any(1, 1'000'000));
    const bool lies = f.kind == scene::FaultKind::kFreeze || f.kind == scene::FaultKind::kReverse;
    if (lies) f.share = 1.0;
    faults[h] = f;
  }
}

void AttackPlan::choose_foreign(test::Random& random) {
  if (!random.happens(0.4)) return;
  for (std::int64_t left = random.any(1, 3); left > 0; --left) {
    Foreign f;
    f.hand = static_cast<int>(random.any(0, 1));
    f.from = random.any(200, kAttackTicks - 100);
    f.ticks = random.happens(0.5) ? 1 : random.any(2, 60);
    const auto node = static_cast<std::uint32_t>(random.any(1, 3));
    const auto torque = random.any(-3000, 3000);
    switch (random.any(0, 6)) {
      case 0:
        f.what = "RPDO";
        f.frame = {0x200U + node, 4, {0x0F, 0x00, byte(torque), byte(torque >> 8)}};
        break;
      case 1:
        f.what = "SYNC";
        f.frame = {0x80U, 0, {}};
        break;
      case 2:
        f.what = "NMT";
        f.frame = {0x000U, 2, {std::array<std::uint8_t, 5>{1, 2, 0x80, 0x81, 0x82}[random() % 5], byte(node)}};
        break;
      case 3:
        f.what = "SDO write";
        f.frame = {0x600U + node, 8, {0x2B, 0x71, 0x60, 0x00, byte(torque), byte(torque >> 8), 0, 0}};
        break;
      case 4:
        f.what = "joint message";
        f.frame = {0x180U + node, 8, {}};
        for (auto& b : std::span(f.frame.data).first(f.frame.dlc)) b = byte(static_cast<std::int64_t>(random() & 0xFF));
        break;
      case 5:
        f.what = "emergency";
        f.frame = {0x80U + node, 8, {0x00, 0x10, 0x01, 0, 0, 0, 0, 0}};
        break;
      default:
        f = flood(f.hand, f.from, f.ticks, static_cast<int>(random.any(1, 10)));
    }
    foreign.push_back(f);
  }
}

void AttackPlan::choose_orders(test::Random& random) {
  using rt::CommandKind;
  constexpr std::array kKinds{CommandKind::kArm,         CommandKind::kDisarm,        CommandKind::kStop,
                              CommandKind::kResetFault,  CommandKind::kResetFault,    CommandKind::kArm,
                              CommandKind::kResetThread, CommandKind::kClutchLeft,    CommandKind::kUnclutchLeft,
                              CommandKind::kClutchRight, CommandKind::kUnclutchRight, CommandKind::kPark,
                              CommandKind::kCalibrate};
  if (random.happens(0.5)) {
    for (std::int64_t left = random.any(1, 8); left > 0; --left)
      orders.push_back({random.any(100, kAttackTicks), kKinds[random() % kKinds.size()]});
  }
  if (random.happens(0.2)) swap_at = random.any(200, kAttackTicks), swap_scene = random.happens(0.5);
  if (random.happens(0.05)) cut_at = random.any(800, kAttackTicks);
  if (random.happens(0.1)) stall_at = random.any(800, 2000), stall_ticks = random.any(1, 60);
}

bool AttackPlan::loses_frames() const {
  const auto disturbs = [](const std::optional<scene::FaultScript>& f) {
    using scene::FaultKind;
    return f && (f->kind == FaultKind::kLose || f->kind == FaultKind::kDelay || f->kind == FaultKind::kReorder ||
                 f->kind == FaultKind::kCorrupt || f->kind == FaultKind::kReboot || f->kind == FaultKind::kDuplicate);
  };
  return frame_loss > 0.0 || !foreign.empty() || stall_at >= 0 || cut_at >= 0 || disturbs(faults[0]) ||
         disturbs(faults[1]);
}

std::string AttackPlan::text() const {
  std::ostringstream s;
  s << "seed " << seed << ": coupling x" << coupling << (jumps ? ", jumps" : "") << (lead_s > 0.0 ? ", pushes on" : "");
  if (frame_loss > 0.0) s << ", " << 100.0 * frame_loss << " % lost";
  for (const auto& f : faults)
    if (f) s << ", fault kind " << static_cast<int>(f->kind) << " node " << f->node << " from " << f->from_s << " s";
  for (const auto& f : foreign) s << ", " << f.what << " at " << f.from << " for " << f.ticks;
  for (const auto& o : orders) s << ", command " << static_cast<int>(o.kind) << " at " << o.tick;
  if (swap_at >= 0) s << ", swap at " << swap_at;
  if (stall_at >= 0) s << ", stall of " << stall_ticks << " at " << stall_at;
  if (cut_at >= 0) s << ", cut at " << cut_at;
  return s.str();
}

AttackedRig::AttackedRig(const AttackPlan& plan) : rig(setup_of(plan), hands_of(plan)), plan_(plan) {
  if (plan.faults[0]) rig.left.faults.emplace(*plan.faults[0]);
  if (plan.faults[1]) rig.right.faults.emplace(*plan.faults[1]);
  rig.cut_left_at = plan.cut_at;
  rig.stall_at = plan.stall_at >= 0 ? plan.stall_at : rig.stall_at;
  rig.stall_for = rt::kPeriod * plan.stall_ticks;
  rig.cycle.listen(plants_);
  rig.each_tick = [this] { befall(); };
}

std::optional<std::string> AttackedRig::run() { return rig.run(kAttackTicks); }

/// Applies the planned events; called between two ticks.
void AttackedRig::befall() {
  const auto tick = rig.cycle.periods();
  for (const auto& f : plan_.foreign) {
    if (tick < f.from || tick >= f.from + f.ticks) continue;
    auto& device = (f.hand == 0 ? rig.left : rig.right).device;
    for (int i = 0; i < f.a_tick && device.pending(kStranger) < kStrangersQueue; ++i)
      device.submit(f.frame, kStranger, rig.time + std::chrono::microseconds(40));
  }
  for (const auto& order : plan_.orders)
    if (order.tick == tick) rig.outlets->commands.push({tick, order.kind});
  if (tick == plan_.swap_at && !swapped_) {
    auto scene = rig.setup.scene;
    if (!plan_.swap_scene) scene.hands.force_scale *= 2.0;
    auto thread = physics::Simulation::make(scene);
    swapped_ = std::make_unique<control::Plant>(
        control::Plant{std::get<physics::Simulation>(std::move(thread)), scene.hands, !plan_.swap_scene});
    plants_.offer(swapped_.get());
  }
}

}  // namespace ligature
