// Energy at both device ports in everything that a hand may do to a thread, with the passivity controller and without.

#include <algorithm>
#include <cstdio>
#include <functional>

#include "host/lab/rehearsal.hpp"
#include "host/lab/rig/haptics/bench_run.hpp"
#include "host/lab/rig/haptics/hands.hpp"
#include "host/lab/rig/haptics/haptics.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {
namespace {

using Will = std::unique_ptr<sim::Intention>;

struct Case {
  const char* name;
  scene::GripperScript script;
  sim::Hand hand{};
  std::function<Will(Will)> wrap = [](Will will) { return will; };
  double frame_loss = 0.0;
  double stiffness = 1.0;  ///< times the scene's coupling, beyond what is admissible
  bool in_quick = false;
};

std::vector<Case> cases() {
  const auto trembling = [](Will w) { return std::make_unique<sim::Trembling>(std::move(w), 0.5e-3, 10.0); };
  const auto adversarial = [](Will w) { return std::make_unique<sim::Adversarial>(std::move(w), 0.02, 0.005); };
  const auto teleporting = [](Will w) {
    return std::make_unique<Teleporting>(std::move(w), 4.0, 4.1, sim::Vec3(0.0, 0.01, 0.02));
  };
  constexpr double kTaut_m = 0.124;
  std::vector<Case> all;
  const auto add = [&](Case c) { all.push_back(std::move(c)); };
  add({"pull tight and release", pull_and_release(kTaut_m), {}, Case{}.wrap, 0.0, 1.0, true});
  add({"jam", jam(kTaut_m, 0.15, 6)});
  add({"slip: lets go and takes again", slip(kTaut_m), {}, Case{}.wrap, 0.0, 1.0, true});
  add({"teleporting hands", pull_and_release(kTaut_m), {}, teleporting});
  add({"1 % of frames lost", pull_and_release(kTaut_m), {}, Case{}.wrap, 0.01});
  add({"5 % of frames lost", pull_and_release(kTaut_m), {}, Case{}.wrap, 0.05, 1.0, true});
  add({"5 % lost, jam", jam(kTaut_m, 0.15, 6), {}, Case{}.wrap, 0.05});
  add({"loose hands", pull_and_release(kTaut_m + 0.006), sim::Hand::holding(0.0)});
  add({"firm hands", pull_and_release(kTaut_m), sim::Hand::holding(0.5)});
  add({"clenched hands", pull_and_release(kTaut_m), sim::Hand::holding(1.0)});
  add({"trembling hands, 10 Hz", pull_and_release(kTaut_m), {}, trembling});
  add({"adversarial hands", pull_and_release(kTaut_m), sim::Hand::holding(0.5), adversarial, 0.0, 1.0, true});
  add({"adversarial hands, 5 % lost", jam(kTaut_m, 0.15, 6), sim::Hand::holding(0.5), adversarial, 0.05});
  add({"too stiff, loose hands", pull_and_release(kTaut_m + 0.004), sim::Hand::holding(0.0), Case{}.wrap, 0.0, 6.0,
       true});
  add({"too stiff, adversarial", pull_and_release(kTaut_m), sim::Hand::holding(0.0), adversarial, 0.0, 6.0});
  return all;
}

Watched play(const HapticsBench& bench, const Case& c, bool controller) {
  RigSetup setup;
  setup.scene = load_scene_or_refuse((bench.scenes / "suture-3-0-knot.toml").string(), {kWeightless});
  auto& hands = setup.scene.hands;
  hands.passivity = controller;
  if (c.stiffness > 1.0) {
    hands.coupling_N_per_m *= c.stiffness;
    hands.device_N_per_m = c.stiffness * hands.device_N_per_m.value_or(500.0);
    hands.override_passivity = true;
  }
  for (auto& body : setup.body) body.hand = c.hand;
  setup.frame_loss = c.frame_loss;
  const double end_s = scene::end_time_s(c.script);
  VirtualRig rig(setup, wrapped(setup, c.script, c.wrap));
  return watch(rig, static_cast<std::int64_t>(1e3 * (end_s + 0.8)));
}

}  // namespace

void measure_ports(const HapticsBench& bench, Verdict& v) {
  Table table({"run", "controller", "least_port_uJ", "least_sum_uJ", "least_account_uJ", "half_count_uJ", "peak_N",
               "step_N", "cut_N", "above_30Hz_mN", "fault"});
  CsvFile traces(bench.out / "haptics-ports.csv", "run,controller,t_s,left_N,right_N,left_uJ,right_uJ");
  double worst_account_J = 0.0, worst_beyond_J = 0.0, step_N = 0.0, limit_N = device::omni().force_step_N;
  int runs = 0, unstable = 0, number = 0;
  std::string example = "none";
  for (const Case& c : cases()) {
    ++number;
    if (bench.quick && !c.in_quick) continue;
    for (const bool controller : {false, true}) {
      const Watched w = play(bench, c, controller);
      const double port_J = std::min(w.lowest_port_J[0], w.lowest_port_J[1]);
      const double account_J = std::min(w.lowest_account_J[0], w.lowest_account_J[1]);
      const double quantum_J = std::max(w.quantum_J[0], w.quantum_J[1]);
      table.row({std::string(c.name), std::string(controller ? "on" : "off"), 1e6 * port_J, 1e6 * w.lowest_sum_J,
                 1e6 * account_J, 1e6 * quantum_J, w.peak_N, w.largest_step_N, w.largest_cut_N,
                 1e3 * w.worst_chatter_N(), double(w.fault)});
      for (std::size_t i = 0; i < w.tip_force_N.size(); i += 4)
        traces.row(std::array{double(number), double(controller), 1e-3 * static_cast<double>(i), w.tip_force_N[i][0],
                              w.tip_force_N[i][1], 1e6 * w.port_J[i][0], 1e6 * w.port_J[i][1]});
      step_N = std::max(step_N, w.largest_step_N);
      if (controller) {
        ++runs;
        worst_account_J = std::min(worst_account_J, account_J);
        worst_beyond_J = std::min(worst_beyond_J, w.lowest_sum_J + w.quantum_J[0] + w.quantum_J[1]);
      } else if (account_J < -1e-3) {
        ++unstable;
        example = c.name;
      }
      std::printf("  %-30s %-3s least port %9.2f uJ, account %9.2f uJ, peak %.2f N, above 30 Hz %6.1f mN, fault %d\n",
                  c.name, controller ? "on" : "off", 1e6 * port_J, 1e6 * account_J, w.peak_N, 1e3 * w.worst_chatter_N(),
                  w.fault);
    }
  }
  traces.close();
  table.write(bench.out / "haptics-ports-table.csv");
  v.claim(worst_account_J >= -1.001e-6,
          "Ports: least account of " + std::to_string(runs) + " runs with the controller, J", digits(worst_account_J),
          "-1e-6 or more");
  v.claim(worst_beyond_J >= -1e-6, "Ports: least true energy of both hands together, half a count apart, J",
          digits(worst_beyond_J), "-1e-6 or more");
  v.claim(unstable > 0, "Ports: runs in which the port gives out more than 1 mJ without it",
          std::to_string(unstable) + " (" + example + ")", "1 or more");
  v.claim(step_N <= limit_N + 1e-9, "Ports: largest step of the force, N", digits(step_N), "up to " + digits(limit_N));
}

}  // namespace ligature::lab
