// Does the hand feel the thread's force? Tests tension, noise, and action = reaction.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/lab/rehearsal.hpp"
#include "host/lab/rig/haptics/bench_run.hpp"
#include "host/lab/rig/haptics/hands.hpp"
#include "host/lab/rig/haptics/haptics.hpp"

namespace ligature::lab {
namespace {

/// Sum of the tensions (stiffness times strain) of the two segments at a node, as a vector. The slack segment counts,
/// too, because it is slightly compressed.
sim::Vec3 pull_on(const Watched& w, const scene::Suture& suture, int node) {
  const double rest_m = suture.length_m / (suture.nodes - 1);
  sim::Vec3 sum = sim::Vec3::Zero();
  for (const int other : {node - 1, node + 1}) {
    if (other < 0 || other >= static_cast<int>(w.nodes_W.size())) continue;
    const sim::Vec3 edge = w.nodes_W[static_cast<std::size_t>(other)] - w.nodes_W[static_cast<std::size_t>(node)];
    sum += suture.paper.stretch_N * (edge.norm() / rest_m - 1.0) * edge.normalized();
  }
  return sum;
}

/// Compares the hands' force with the tension of a straight weightless thread of the paper's model between them. This
/// tension is stiffness times strain, independent of coupling and contacts.
void steady_pull(const HapticsBench& bench, Verdict& v) {
  RigSetup setup;
  setup.scene = load_scene_or_refuse((bench.scenes / "paper.toml").string(),
                                     {"world.gravity_m_per_s2=[0,0,0]", "hands.force_scale=0.01"});
  scene::GripperScript script;
  for (std::size_t h = 0; h < 2; ++h) {
    const double start = h == 0 ? 3.0 : 1.5, pull = h == 0 ? 0.07 : -0.07;
    script.keys[h] = {{0.5, {0, 0, start}, false},
                      {1.2, {0, 0, start}, true},
                      {3.0, {0, 0, start + pull}, true},
                      {7.5, {0, 0, start + pull}, true}};
  }
  VirtualRig rig(setup, script);
  const Watched w = watch(rig, 6500, 6300);
  Table table({"hand", "thread_on_node_N", "times_scale_N", "at_the_hand_N", "deviation"});
  double worst = 0.0, least_N = 1e9;
  for (std::size_t h = 0; h < 2; ++h) {
    const int node = rig.thread.hand(h == 0 ? physics::Hand::kLeft : physics::Hand::kRight).node;
    if (node < 0) {
      v.claim(false, "Fidelity: both hands hold the thread", "no", "yes");
      return;
    }
    const sim::Vec3 thread_N = pull_on(w, setup.scene.suture, node);
    const sim::Vec3 expected_N = setup.scene.hands.force_scale * thread_N, felt_N = w.mean_N(h, 5300, 6400);
    const double deviation = std::abs(felt_N.norm() / expected_N.norm() - 1.0);
    worst = std::max(worst, deviation);
    least_N = std::min(least_N, expected_N.norm());
    table.row({std::string(h == 0 ? "left" : "right"), thread_N.norm(), expected_N.norm(), felt_N.norm(), deviation});
  }
  table.print();
  table.write(bench.out / "haptics-steady-pull.csv");
  v.claim(worst <= 0.02 && least_N > 0.05,
          "Fidelity: steady pull, force at the hand against the thread's on its node times scale",
          digits(worst) + " at " + digits(least_N) + " N", "up to 0.02");
}

/// Tension of the thread between a hand and the knot, mean over nodes 5 to 8 cm from the middle.
double tension_N(const Watched& w, std::size_t hand) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < w.nodes_W.size(); ++i) {
    const double out_m = hand == 0 ? -w.nodes_W[i].x() : w.nodes_W[i].x();
    if (out_m < 0.05 || out_m > 0.08) continue;
    sum += w.tension_N[i];
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// The knotted suture, pulled tight and held.
void tight_knot(const HapticsBench& bench, Verdict& v) {
  RigSetup setup;
  setup.scene = load_scene_or_refuse((bench.scenes / "suture-3-0-knot.toml").string(), {kWeightless});
  const scene::GripperScript script = pull_and_release(bench.taut_m, 2.0, 4.0);
  VirtualRig rig(setup, script);
  const std::size_t from = 4800, to = 6800;
  const Watched w = watch(rig, 6900, to - 100);
  const sim::Vec3 left = w.mean_N(0, from, to), right = w.mean_N(1, from, to);
  const double mean_N = 0.5 * (left.norm() + right.norm());
  const double chatter_N = std::max(w.chatter_N(0, from, to), w.chatter_N(1, from, to));
  const double apart = (left + right).norm() / std::max(mean_N, 1e-9);
  const double scale = setup.scene.hands.force_scale;
  const double worst = std::max(std::abs(left.norm() / (scale * tension_N(w, 0)) - 1.0),
                                std::abs(right.norm() / (scale * tension_N(w, 1)) - 1.0));
  Table table({"left_N", "right_N", "tension_left_N", "tension_right_N", "deviation", "sum_of_mean", "above_30Hz_mN",
               "share_of_mean", "largest_step_N"});
  table.row({left.norm(), right.norm(), tension_N(w, 0), tension_N(w, 1), worst, apart, 1e3 * chatter_N,
             chatter_N / mean_N, w.largest_step_N});
  table.print();
  table.write(bench.out / "haptics-tight-knot.csv");
  bool limited = false;
  for (std::size_t i = from; i < std::min(to, rig.records.size()); ++i)
    limited = limited || rig.records[i].limits[0] != 0 || rig.records[i].limits[1] != 0;
  v.claim(!limited, "Fidelity: a limit acts in the hold", limited ? "yes" : "no", "no");
  v.claim(worst <= 0.02,
          "Fidelity: steady pull on the real suture, force at each hand against the thread's tension times scale",
          digits(worst) + " at " + digits(mean_N) + " N", "up to 0.02");
  v.claim(mean_N > 0.2 && apart <= 0.02, "Fidelity: two hands on a tight knot, difference from equal and opposite",
          digits(apart) + " of " + digits(mean_N) + " N", "up to 0.02");
  v.claim(chatter_N < 0.01 * mean_N && chatter_N < 0.020, "Fidelity: chatter above 30 Hz in a steady hold, mN rms",
          digits(1e3 * chatter_N), "below 1 % of the mean and 20");
}

}  // namespace

void measure_fidelity(const HapticsBench& bench, Verdict& v) {
  steady_pull(bench, v);
  tight_knot(bench, v);
}

}  // namespace ligature::lab
