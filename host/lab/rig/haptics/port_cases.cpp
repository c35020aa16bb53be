#include "host/lab/rig/haptics/port_cases.hpp"

#include "host/lab/rehearsal.hpp"
#include "protocol/device/device_file.hpp"

namespace ligature::lab {
namespace {

/// Drives whose continuous torque is 0.3 times that of the device record, with a thermal time constant of 0.5 s: they
/// reduce their torque long before the controller's own limit would act.
void hot_drives(RigSetup& setup) {
  for (auto& body : setup.body) body.motors = {0.3 * body.motors.continuous_Nm, 0.5};
}

void cartesian(const HapticsBench& bench, RigSetup& setup) {
  auto read = device::load_device(bench.scenes / "devices/cartesian.toml");
  setup.device = std::get<device::Device>(std::move(read));
  for (auto& body : setup.body) {
    const sim::Hand hand = body.hand;
    body = sim::Body::of(setup.device);
    body.hand = hand;
  }
}

void add_calm(const HapticsBench& bench, std::vector<PortCase>& all) {
  all.push_back({.name = "pull tight and release", .script = pull_and_release(bench.taut_m), .in_quick = true});
  all.push_back({.name = "jam of the knot", .script = jam(bench.taut_m, 0.15, 6)});
  all.push_back({.name = "jam against a peg",
                 .script = against_peg(bench.taut_at_peg_m, 0.045),
                 .overrides = {kWeightless, kPeg},
                 .in_quick = true});
  all.push_back({.name = "slip: lets go and takes again", .script = slip(bench.taut_m), .in_quick = true});
  all.push_back({.name = "one pulls, one gives way",
                 .script = give_way(bench.taut_m, 0.03),
                 .gives_way = true,
                 .in_quick = true});
  all.push_back(
      {.name = "hot drives", .script = pull_and_release(bench.taut_m), .trouble = hot_drives, .in_quick = true});
  all.push_back({.name = "cartesian device",
                 .script = pull_and_release(bench.taut_m),
                 .trouble = [bench](RigSetup& s) { cartesian(bench, s); },
                 .in_quick = true});
}

void add_lossy(const HapticsBench& bench, std::vector<PortCase>& all) {
  all.push_back({.name = "1 % of frames lost", .script = pull_and_release(bench.taut_m), .frame_loss = 0.01});
  all.push_back(
      {.name = "5 % of frames lost", .script = pull_and_release(bench.taut_m), .frame_loss = 0.05, .in_quick = true});
  all.push_back({.name = "5 % lost; jam", .script = jam(bench.taut_m, 0.15, 6), .frame_loss = 0.05});
  all.push_back({.name = "5 % lost; slip", .script = slip(bench.taut_m), .frame_loss = 0.05});
}

void add_hands(const HapticsBench& bench, std::vector<PortCase>& all) {
  const auto trembling = [](Will w) { return std::make_unique<sim::Trembling>(std::move(w), 0.5e-3, 10.0); };
  const auto adversarial = [](Will w) { return std::make_unique<sim::Adversarial>(std::move(w), 0.02, 0.005); };
  const auto teleporting = [](Will w) {
    return std::make_unique<Teleporting>(std::move(w), 4.0, 4.1, sim::Vec3(0.0, 0.01, 0.02));
  };
  const auto loose = sim::Hand::holding(0.0), firm = sim::Hand::holding(0.5), fist = sim::Hand::holding(1.0);
  const auto pull = pull_and_release(bench.taut_m);
  all.push_back({.name = "loose hands", .script = pull_and_release(bench.taut_m + 0.006), .hand = loose});
  all.push_back({.name = "firm hands", .script = pull, .hand = firm});
  all.push_back({.name = "clenched hands", .script = pull, .hand = fist});
  all.push_back({.name = "trembling hands, 10 Hz", .script = pull, .wrap = trembling});
  all.push_back({.name = "teleporting hands", .script = pull, .wrap = teleporting});
  all.push_back(
      {.name = "adversarial hands", .script = pull, .hand = firm, .wrap = adversarial, .wild = true, .in_quick = true});
  all.push_back({.name = "adversarial; 5 % lost",
                 .script = jam(bench.taut_m, 0.15, 6),
                 .hand = firm,
                 .wrap = adversarial,
                 .frame_loss = 0.05,
                 .wild = true});
  all.push_back({.name = "too stiff; loose hands", .script = pull, .hand = loose, .stiffness = 6.0});
  all.push_back(
      {.name = "too stiff; adversarial", .script = pull, .hand = loose, .wrap = adversarial, .stiffness = 6.0});
  const auto tugging = [](Will w) {
    return std::make_unique<Teleporting>(std::move(w), 2.9, 2.95, sim::Vec3(0.0, 0.0, -0.015));
  };
  std::vector<std::string> taut = short_thread();
  taut.emplace_back(kWeightless);
  taut.emplace_back("suture.stretch_damping_s=0");
  // Two fingers on the stylus (least damping), and one short tug.
  all.push_back({.name = "short thread; too stiff; two fingers",
                 .script = on_a_short_thread(0.02),
                 .hand = {60.0, 0.5, 0.0, 0.0, 0.0},
                 .wrap = tugging,
                 .stiffness = 20.0,
                 .overrides = taut,
                 .unstable_without = true});
}

}  // namespace

std::vector<PortCase> port_cases(const HapticsBench& bench) {
  std::vector<PortCase> all;
  add_calm(bench, all);
  add_lossy(bench, all);
  add_hands(bench, all);
  return all;
}

Watched play(const HapticsBench& bench, const PortCase& c, bool controller) {
  RigSetup setup;
  setup.scene = load_scene_or_refuse((bench.scenes / "suture-3-0-knot.toml").string(), c.overrides);
  auto& hands = setup.scene.hands;
  hands.passivity = controller;
  if (c.stiffness > 1.0) {
    hands.coupling_N_per_m *= c.stiffness;
    hands.device_N_per_m = c.stiffness * hands.device_N_per_m.value_or(500.0);
    hands.override_passivity = true;
  }
  for (auto& body : setup.body) body.hand = c.hand;
  setup.frame_loss = c.frame_loss;
  setup.seed = bench.seed;
  c.trouble(setup);
  const double end_s = scene::end_time_s(c.script);
  VirtualRig rig(setup, wrapped(setup, c.script, c.wrap));
  return watch(rig, static_cast<std::int64_t>(1e3 * (end_s + 0.8)));
}

}  // namespace ligature::lab
