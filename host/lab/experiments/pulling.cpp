// Experiment `pulling`: the paper's Table III, the force in each haptic frame (here: each tick of 1 ms) for one-hand
// and two-hand pulls. The table also gives the condition under which force passes along the thread: A, no segment is at
// its limit of length and only the springs act; B, segments at a limit are rigid and pass the force on; C, as B, with
// two hands (firmware/physics/paper/propagation.hpp).

#include <algorithm>
#include <array>
#include <cmath>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {
namespace {

using physics::Hand;
using physics::Propagation;

struct Pull {
  const char* name;
  scene::GripperScript script;
};

/// One hand takes the thread 1 m above its free end, pulls it aside and comes back; the other hand is absent.
Pull one_hand() {
  return {"one-hand",
          {{{},
            {{0.2, {0, 0, 1.5}, false},
             {0.5, {0, 0, 1.5}, true},
             {3.0, {2.2, 0, 2.0}, true},
             {5.0, {4.6, 0, 3.0}, true},
             {5.5, {4.6, 0, 3.0}, true},
             {8.0, {0.5, 0, 1.6}, true},
             {8.5, {0.5, 0, 1.6}, false}}}}};
}

/// Two hands take the thread one metre apart and pull it taut between them.
Pull two_hands() {
  return {"two-hand",
          {{{{0.2, {0, 0, 3.0}, false},
             {0.5, {0, 0, 3.0}, true},
             {3.0, {-0.5, 0, 3.4}, true},
             {5.0, {-0.95, 0, 3.4}, true},
             {5.5, {-0.95, 0, 3.4}, true},
             {8.0, {-0.2, 0, 3.2}, true},
             {8.5, {-0.2, 0, 3.2}, false}},
            {{0.2, {0, 0, 1.5}, false},
             {0.5, {0, 0, 1.5}, true},
             {3.0, {0.5, 0, 2.8}, true},
             {5.0, {0.95, 0, 3.4}, true},
             {5.5, {0.95, 0, 3.4}, true},
             {8.0, {0.2, 0, 1.8}, true},
             {8.5, {0.2, 0, 1.8}, false}}}}};
}

struct Felt {
  double peak_N = 0.0;                   ///< largest hand force at the device, after scaling and the force limit
  double peak_unlimited_N = 0.0;         ///< largest force after scaling, before the force limit
  std::array<int, 4> frames{};           ///< number of ticks under each condition: none, A, B, C
  double longest = 0.0, shortest = 2.0;  ///< longest and shortest segment, relative to the rest length
  bool finite = true;
};

Felt play(const Pull& pull, const scene::Scene& scene, CsvFile& file, double number) {
  Rehearsal r(scene, pull.script);
  Felt felt;
  const double rest_m = scene.suture.length_m / (scene.suture.nodes - 1);
  const double end_s = scene::end_time_s(pull.script) + 0.5;
  while (r.time_s() < end_s && felt.finite) {
    felt.finite = r.tick();
    std::array<double, 2> device_N{};
    auto condition = Propagation::kNone;
    for (const auto hand : {Hand::kLeft, Hand::kRight}) {
      const auto& h = r.simulation().hand(hand);
      const double scaled_N = scene.hands.force_scale * h.f_W.norm();
      device_N[static_cast<std::size_t>(hand)] = std::min(scaled_N, scene.hands.max_force_N);
      felt.peak_unlimited_N = std::max(felt.peak_unlimited_N, scaled_N);
      if (h.condition > condition) condition = h.condition;
    }
    felt.peak_N = std::max({felt.peak_N, device_N[0], device_N[1]});
    ++felt.frames[static_cast<std::size_t>(condition)];
    const auto p = r.simulation().nodes_W();
    for (std::size_t k = 1; k < p.size(); ++k) {
      const double length = (p[k] - p[k - 1]).norm() / rest_m;
      felt.longest = std::max(felt.longest, length);
      felt.shortest = std::min(felt.shortest, length);
    }
    const double cells[] = {number, static_cast<double>(r.ticks()), device_N[0], device_N[1],
                            static_cast<double>(condition)};
    file.row(cells);
  }
  return felt;
}

}  // namespace

int experiment_pulling(const Bench& bench) {
  const auto scene = load_scene_or_refuse((bench.scenes / "paper.toml").string(), {"hands.propagation=true"});
  std::printf("pulling: force at the devices (world force x %.3g, at most %.1f N), one haptic frame a tick\n",
              scene.hands.force_scale, scene.hands.max_force_N);
  Table table({"pull", "peak_N", "peak_before_limit_N", "frames_A", "frames_B", "frames_C", "longest_of_rest",
               "shortest_of_rest"});
  Verdict v("pulling");
  CsvFile file(bench.out / "pulling-frames.csv", "pull,frame,left_N,right_N,condition");
  double number = 0.0;
  for (const auto& pull : {one_hand(), two_hands()}) {
    const auto f = play(pull, scene, file, number++);
    const std::string who(pull.name);
    const bool two = !pull.script.keys[0].empty();
    table.row({who, f.peak_N, f.peak_unlimited_N, double(f.frames[1]), double(f.frames[2]), double(f.frames[3]),
               f.longest, f.shortest});
    v.claim(f.finite && f.peak_N <= scene.hands.max_force_N + 1e-12, who + ": largest force at a device, N",
            digits(f.peak_N), "up to 3.3");
    v.claim(f.peak_N > 0.05, who + ": it is felt, N", digits(f.peak_N), "above 0.05");
    v.claim(f.frames[1] > 0 && f.frames[2] + f.frames[3] > 0, who + ": frames under A, and under B or C",
            std::to_string(f.frames[1]) + ", " + std::to_string(f.frames[2] + f.frames[3]), "both some");
    v.claim((f.frames[3] > 0) == two, who + ": frames under C, which needs two hands", std::to_string(f.frames[3]),
            two ? "some" : "none");
    v.claim(f.longest <= scene.hands.max_length + 1e-6 && f.shortest >= scene.hands.min_length - 1e-6,
            who + ": segments, of rest length", digits(f.shortest, 7) + " .. " + digits(f.longest, 7),
            digits(scene.hands.min_length) + " .. " + digits(scene.hands.max_length));
  }
  file.close();
  table.print();
  table.write(bench.out / "pulling.csv");
  draw("pulling.py", {bench.out / "pulling-frames.csv"}, bench.out / "pulling.png");
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
