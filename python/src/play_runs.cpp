#include "python/src/play_runs.hpp"

#include "host/lab/outcome.hpp"
#include "host/lab/script_tools.hpp"
#include "python/src/arrays.hpp"
#include "python/src/signals.hpp"

namespace ligature::python {
namespace {

constexpr int kMostThreads = 256;

double duration_of(const scene::GripperScript& script, std::optional<double> duration_s) {
  return duration_s.value_or(lab::default_duration_s(script));
}

}  // namespace

Run run_here(Sim& sim, const scene::GripperScript& script, std::optional<double> duration_s, double shape_every_s,
             double start_s) {
  const auto& scene = sim.idle().scene().scene;
  const auto orders = orders_of(scene, start_s, duration_of(script, duration_s), shape_every_s, 1);
  // A copy: other Python threads may change the script during the run
  const auto played = script;  // NOLINT(performance-unnecessary-copy-initialization)
  Signals signals;
  Run run;
  {
    const Sim::Busy busy(sim);
    const nb::gil_scoped_release free;
    run = play(sim.simulation(), scene, played, orders, [&] { return signals(); });
  }
  sim.add_ticks(static_cast<std::int64_t>(run.trace.size() / Run::kColumns));
  signals.rethrow();
  return run;
}

std::vector<Run> run_copies(Sim& sim, const std::vector<const scene::GripperScript*>& scripts, int threads,
                            std::optional<double> duration_s, double shape_every_s, double start_s) {
  const auto& scene = sim.idle().scene().scene;
  if (threads < 1 || threads > kMostThreads)
    throw lab::Refusal("threads: found " + std::to_string(threads) + ", allowed 1 .. " + std::to_string(kMostThreads));
  std::vector<Orders> orders;
  std::vector<scene::GripperScript> played;
  for (const auto* script : scripts) {
    if (script == nullptr) throw lab::Refusal("scripts: found None, allowed a Script");
    orders.push_back(orders_of(scene, start_s, duration_of(*script, duration_s), shape_every_s, scripts.size()));
    played.push_back(*script);
  }
  std::vector<const scene::GripperScript*> each;
  each.reserve(played.size());
  for (const auto& script : played) each.push_back(&script);
  const auto workers = static_cast<unsigned>(std::min<std::size_t>(static_cast<std::size_t>(threads), each.size()));
  Signals signals;
  std::vector<Run> runs;
  {
    const Sim::Busy busy(sim);
    const nb::gil_scoped_release free;
    runs = play_all(sim.simulation(), scene, each, orders, workers, [&] { return signals(); });
  }
  signals.rethrow();
  return runs;
}

}  // namespace ligature::python
