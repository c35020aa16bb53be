// Experiment `unknotting`: a pull that opens a loop on the desk, as in Figs. 6 and 7 of the paper; a map of all pulls
// that open a knot; and a planner that chooses such a pull, which the paper does not give.

#include <cmath>

#include "host/console/progress.hpp"
#include "host/lab/experiments/experiment.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/unknotting/loose_knots.hpp"
#include "host/lab/unknotting/planner.hpp"

namespace ligature::lab {
namespace {

using physics::Vec3;

constexpr double kSettle_s = 5.0;
// a pull that does not open the knot: the last node, in the direction in which the tail already runs
const Pull kWrong{49, {1.0, 0.0, 0.0}};

struct Extent {
  int knots = 0;       ///< number of knots of each kind, for the planner
  int enough = 0;      ///< of these it must undo so many
  int every_node = 1;  ///< the map of pulls has every so many-th node
};
constexpr Extent kWhole{10, 8, 1}, kQuick{1, 1, 7};

/// Experiment on the desk: pulls the loop at the node that the planner chose, and at a wrong node. Keeps the shapes for
/// the picture.
void pull_on_desk(const Bench& bench, Table& table, Verdict& v) {
  const auto scene = load_scene_or_refuse((bench.scenes / "desk.toml").string(), {});
  Rehearsal r(scene, {});
  r.run_until(kSettle_s);
  const auto at = r.simulation().nodes_W();
  const std::vector<Vec3> shape(at.begin(), at.end());
  const auto before = knot_of(r.simulation());
  const auto core = core_of(shape);
  double size_m = 0.0;
  for (int k = core.first + 1; k <= core.last; ++k)
    size_m += (shape[std::size_t(k)] - shape[std::size_t(k - 1)]).norm();
  const auto plan = plan_pull(shape, scene);
  CsvFile file(bench.out / "unknotting-desk.csv", "picture,node,x_m,y_m,z_m");
  const auto take = [&](double picture, std::span<const Vec3> nodes) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double cells[] = {picture, double(k), nodes[k].x(), nodes[k].y(), nodes[k].z()};
      file.row(cells);
    }
  };
  take(0.0, shape);
  v.claim(before.type == "4_1", "desk: the knot to undo", before.type, "4_1");
  v.claim(plan.has_value(), "desk: the planner names a pull", plan ? "node " + std::to_string(plan->pull.node) : "none",
          "one");
  if (plan) {
    auto thread = thread_of_shape(shape, scene);
    const auto right = do_pull(thread, scene, plan->pull);
    take(1.0, thread.nodes_W());
    table.row(
        {std::string("desk, right node"), double(plan->pull.node), before.type, right.knot.type, right.peak_N, 0.0});
    v.claim(right.knot.type == "0_1", "desk: after pulling node " + std::to_string(plan->pull.node), right.knot.type,
            "0_1");
  }
  auto thread = thread_of_shape(shape, scene);
  const auto wrong = do_pull(thread, scene, kWrong);
  take(2.0, thread.nodes_W());
  table.row({std::string("desk, wrong node"), double(kWrong.node), before.type, wrong.knot.type, wrong.peak_N,
             wrong.knot_size_m});
  v.claim(wrong.knot.type == "4_1" && wrong.knot_size_m < 0.85 * size_m,
          "desk: after pulling node " + std::to_string(kWrong.node) + " the knot, and the thread in it, m",
          wrong.knot.type + ", " + digits(wrong.knot_size_m) + " of " + digits(size_m), "4_1, tighter by 15 % or more");
  file.close();
}

struct Pulls {
  int tried = 0, untie = 0;
};

/// Tries a pull in six directions at every node, or at every `every_node`-th one.
Pulls map_pulls(const LooseKnot& knot, int every_node, Table& map, console::Progress& progress) {
  const int n = static_cast<int>(knot.thread.nodes_W().size());
  const std::vector<Vec3> shape(knot.thread.nodes_W().begin(), knot.thread.nodes_W().end());
  Pulls pulls;
  for (int node = 1; node < n; node += every_node) {
    progress.show(double(node) / n, "map of " + knot.type + ", node " + std::to_string(node));
    for (std::size_t d = 0; d < six_directions().size(); ++d) {
      const auto result = try_pull(shape, knot.scene, {node, six_directions()[d]});
      ++pulls.tried;
      pulls.untie += result.knot.type == "0_1";
      map.row({knot.type, double(node), std::string(direction_name(d)), result.knot.type, result.peak_N});
    }
  }
  return pulls;
}

/// For each knot the planner chooses a pull from the shape, and the pull is applied to the thread. @return how many
/// knots opened.
int undo(int knots, const std::string& scene, const scene::GripperScript& script, const std::string& type, Table& plans,
         console::Progress& progress) {
  int undone = 0, drawn = 0;
  for (int k = 0; k < knots; ++k) {
    progress.show(double(k) / knots, "planner, " + type + " number " + std::to_string(k + 1));
    auto knot = tie_loosely(scene, script, type, static_cast<std::uint32_t>(k), drawn);
    const auto nodes = knot.thread.nodes_W();
    const std::vector<Vec3> shape(nodes.begin(), nodes.end());
    const auto plan = plan_pull(shape, knot.scene);
    if (!plan) {
      plans.row({type, double(k + 1), double(knot.scene.suture.nodes), -1.0, std::string("none"), 0.0, type});
      continue;
    }
    const auto result = do_pull(knot.thread, knot.scene, plan->pull);
    const auto& d = plan->pull.direction;
    std::string way = "(" + digits(d.x()) + " " + digits(d.y()) + " " + digits(d.z()) + ")";
    plans.row({type, double(k + 1), double(knot.scene.suture.nodes), double(plan->pull.node), way, double(plan->tried),
               result.knot.type});
    undone += result.knot.type == "0_1";
  }
  return undone;
}

}  // namespace

int experiment_unknotting(const Bench& bench) {
  const Extent& extent = bench.quick ? kQuick : kWhole;
  std::printf("unknotting: one hand, a straight pull of %.1f m in %.0f s, the frame fixed\n", kPullLength_m,
              kPullLength_m / kPullSpeed_m_per_s);
  Verdict v("unknotting");
  Table desk({"case", "node", "before", "after", "peak_N", "thread_in_knot_m"});
  Table map({"knot", "node", "direction", "after", "peak_N"});
  Table plans({"knot", "number", "nodes", "pull_node", "direction", "rehearsed", "after"});
  pull_on_desk(bench, desk, v);
  const auto scene = (bench.scenes / "paper.toml").string();
  {
    console::Progress progress("unknotting");
    for (const auto& [type, file] : {std::pair{"3_1", "overhand.csv"}, std::pair{"4_1", "figure-eight.csv"}}) {
      const auto script = load_script_or_refuse((bench.scenes / "operators" / file).string());
      int drawn = 0;
      const auto loose = tie_loosely(scene, script, type, 0, drawn);
      const Pulls pulls = map_pulls(loose, extent.every_node, map, progress);
      v.claim(pulls.untie > 0 && pulls.untie < pulls.tried,
              std::string(type) + ": pulls that untie, of " + std::to_string(pulls.tried), std::to_string(pulls.untie),
              "some, not all");
      const int undone = undo(extent.knots, scene, script, type, plans, progress);
      v.claim(undone >= extent.enough,
              std::string(type) + ": loose knots undone by the planned pull, of " + std::to_string(extent.knots),
              std::to_string(undone), std::to_string(extent.enough) + " or more");
    }
  }
  desk.print();
  plans.print();
  desk.write(bench.out / "unknotting.csv");
  map.write(bench.out / "unknotting-map.csv");
  plans.write(bench.out / "unknotting-plans.csv");
  if (!bench.quick)
    draw("unknotting.py", {bench.out / "unknotting-map.csv", bench.out / "unknotting-desk.csv"},
         bench.out / "unknotting.png");
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
