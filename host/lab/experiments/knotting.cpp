// Experiment `knotting`: two hands tie a trefoil and a figure-eight, and the mirror image of each. The knots must
// remain after the release.

#include <algorithm>

#include "host/console/progress.hpp"
#include "host/lab/experiments/experiment.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/script_moves.hpp"

namespace ligature::lab {
namespace {

constexpr double kWait_s = 10.0;

struct Tied {
  knot::KnotResult at_release, later;
  double peak_N = 0.0;       ///< largest hand force during tying, in the thread's world
  double last_pull_N = 0.0;  ///< largest hand force in the last 10 ms before release
};

void take_shape(CsvFile& file, double number, double t_s, const Rehearsal& r) {
  const auto nodes = r.simulation().nodes_W();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double cells[] = {number, t_s, static_cast<double>(i), nodes[i].x(), nodes[i].y(), nodes[i].z()};
    file.row(cells);
  }
}

Tied tie(const scene::Scene& scene, const scene::GripperScript& script, CsvFile* shapes, double number) {
  Rehearsal r(scene, script);
  Tied tied;
  const double release_s = release_time_s(script);
  constexpr int kPictures = 6;
  int picture = 0;
  while (r.time_s() < release_s - 0.5 * scene.time.tick_s && r.tick()) {
    const double force_N = std::max(r.simulation().hand(physics::Hand::kLeft).f_W.norm(),
                                    r.simulation().hand(physics::Hand::kRight).f_W.norm());
    tied.peak_N = std::max(tied.peak_N, force_N);
    if (r.time_s() > release_s - 0.01) tied.last_pull_N = std::max(tied.last_pull_N, force_N);
    if (shapes && r.time_s() >= release_s * (picture + 1) / kPictures) {
      take_shape(*shapes, number, r.time_s(), r);
      ++picture;
    }
  }
  tied.at_release = knot_of(r.simulation());
  r.run_until(release_s + kWait_s);
  tied.later = knot_of(r.simulation());
  if (shapes) take_shape(*shapes, number, r.time_s(), r);
  return tied;
}

std::string text(const knot::KnotResult& k) { return k.type + " " + k.handedness; }

struct Case {
  const char* script;
  const char* type;
  const char* hand;
};

constexpr Case kCases[] = {{"overhand", "3_1", "right"},
                           {"overhand-mirrored", "3_1", "left"},
                           {"figure-eight", "4_1", "amphichiral"},
                           {"figure-eight-mirrored", "4_1", "amphichiral"}};

}  // namespace

int experiment_knotting(const Bench& bench) {
  std::printf("knotting: operator's scripts, frame fixed, two hands; looked at when released and %.0f s later\n",
              kWait_s);
  Table table({"script", "nodes", "friction", "at_release", "10_s_later", "peak_N", "pull_at_release_N"});
  Verdict verdict("knotting");
  CsvFile shapes(bench.out / "knotting-shapes.csv", "script,t_s,node,x_m,y_m,z_m");
  {
    console::Progress progress("knotting");
    double number = 0.0;
    for (const auto& c : kCases) {
      const auto script =
          load_script_or_refuse((bench.scenes / "operators" / (std::string(c.script) + ".csv")).string());
      const std::string wanted = std::string(c.type) + " " + c.hand;
      for (const int nodes : {35, 50}) {
        progress.show(number / 4.0, std::string(c.script) + ", N = " + std::to_string(nodes));
        const auto scene =
            load_scene_or_refuse((bench.scenes / "paper.toml").string(), {"suture.nodes=" + std::to_string(nodes)});
        const auto tied = tie(scene, script, nodes == 50 ? &shapes : nullptr, number);
        table.row({std::string(c.script), static_cast<double>(nodes), scene.contact.friction, text(tied.at_release),
                   text(tied.later), tied.peak_N, tied.last_pull_N});
        const std::string who = std::string(c.script) + ", N = " + std::to_string(nodes);
        verdict.claim(text(tied.at_release) == wanted && text(tied.later) == wanted,
                      who + ": knot at release and 10 s later", text(tied.at_release) + ", " + text(tied.later),
                      wanted);
        verdict.claim(tied.last_pull_N < 0.5 * tied.peak_N, who + ": eased before it is let go, N",
                      digits(tied.last_pull_N) + " of " + digits(tied.peak_N), "below half of the peak");
      }
      number += 1.0;
    }
  }
  shapes.close();
  table.print();
  table.write(bench.out / "knotting.csv");
  draw("knotting.py", {bench.out / "knotting-shapes.csv"}, bench.out / "knotting.png");
  return verdict.conclude(bench.out);
}

}  // namespace ligature::lab
