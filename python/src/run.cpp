#include "python/src/run.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>

#include "host/lab/every.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/script_tools.hpp"
#include "host/lab/trace_row.hpp"
#include "python/src/clock.hpp"
#include "python/src/float_mode.hpp"

namespace ligature::python {
namespace {

constexpr double kMostBytes = 4e9;  // limit on the memory for the results of all runs
constexpr double kLongest_s = 1e6;
constexpr int kTicksAQuestion = 32;
constexpr std::chrono::milliseconds kBetweenQuestions(20);  // each wake-up takes a core from a worker for a moment

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void add_shape(Run& run, double t_s, std::span<const physics::Vec3> nodes_W) {
  run.shape_t_s.push_back(t_s);
  for (const auto& p : nodes_W) run.shapes.insert(run.shapes.end(), p.data(), p.data() + 3);
}

void add_row(Run& run, const lab::TraceRow& r) {
  const double cells[Run::kColumns] = {r.t_s,         r.left_N.x(),  r.left_N.y(),  r.left_N.z(),
                                       r.right_N.x(), r.right_N.y(), r.right_N.z(), r.kinetic_J,
                                       r.potential_J, r.max_stretch, r.min_gap_m,   static_cast<double>(r.contacts)};
  run.trace.insert(run.trace.end(), std::begin(cells), std::end(cells));
}

}  // namespace

Orders orders_of(const scene::Scene& scene, double start_s, double duration_s, double shape_every_s, std::size_t runs) {
  const double tick_s = scene.time.tick_s;
  if (!(duration_s >= tick_s && duration_s <= kLongest_s))
    throw lab::Refusal("duration_s: found " + digits(duration_s) + ", allowed one tick (" + digits(tick_s) +
                       " s) .. 1e6 s");
  if (!(shape_every_s > 0.0 && std::isfinite(shape_every_s)))
    throw lab::Refusal("shape_every_s: found " + digits(shape_every_s) + ", allowed more than 0 s");
  if (!(start_s >= 0.0 && start_s <= kLongest_s))
    throw lab::Refusal("start_s: found " + digits(start_s) + ", allowed 0 .. 1e6 s");
  const double ticks = std::round(duration_s / tick_s);
  const double shapes = 2.0 + std::min(ticks, duration_s / shape_every_s);
  const double bytes = 8.0 * static_cast<double>(runs) *
                       (ticks * static_cast<double>(Run::kColumns) + shapes * (1.0 + 3.0 * scene.suture.nodes));
  if (bytes > kMostBytes)
    throw lab::Refusal("duration_s: found " + digits(duration_s) + ", which keeps " + digits(bytes / 1e9) +
                       " GB, allowed 4: run in pieces (start_s), or with a longer shape_every_s");
  return {std::llround(start_s / tick_s), static_cast<std::int64_t>(ticks), shape_every_s};
}

Run play(physics::Simulation& simulation, const scene::Scene& scene, const scene::GripperScript& script,
         const Orders& orders, const std::function<bool()>& go_on) {
  const DefaultFloats floats;
  const double tick_s = scene.time.tick_s;
  const auto clock = clock_of(tick_s);
  const auto time_s = [&](std::int64_t done) { return clock.time_s(orders.first_tick + done); };
  Run run;
  run.nodes = simulation.nodes_W().size();
  run.trace.reserve(Run::kColumns * static_cast<std::size_t>(orders.ticks));
  lab::Every shape_due(orders.shape_every_s);
  add_shape(run, time_s(0), simulation.nodes_W());
  bool shape_written = true;
  std::int64_t done = 0;
  while (done < orders.ticks) {
    if (done % kTicksAQuestion == 0 && !go_on()) break;
    simulation.tick(lab::tools_at(script, static_cast<double>(orders.first_tick + done + 1) * tick_s));
    const auto row = lab::row_of(simulation, scene, time_s(done + 1));
    if (!simulation.diagnostics().finite || !row.is_finite()) {
      run.finite = false;
      run.failure = lab::divergence(simulation.diagnostics(), scene, orders.first_tick + done + 1, row.t_s);
      break;
    }
    add_row(run, row);
    ++done;
    shape_written = shape_due.is_due(time_s(done) - time_s(0), tick_s);
    if (shape_written) add_shape(run, time_s(done), simulation.nodes_W());
  }
  if (!shape_written) add_shape(run, static_cast<double>(orders.first_tick + done) * tick_s, simulation.nodes_W());
  return run;
}

std::vector<Run> play_all(const physics::Simulation& from, const scene::Scene& scene,
                          std::span<const scene::GripperScript* const> scripts, std::span<const Orders> orders,
                          unsigned threads, const std::function<bool()>& go_on) {
  std::vector<Run> runs(scripts.size());
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> stop = false;
  std::vector<std::exception_ptr> why(threads);
  std::mutex lock;
  std::condition_variable one_ended;
  unsigned ended = 0;  // workers; guarded by lock
  const auto work = [&](std::size_t worker) noexcept {
    try {
      for (std::size_t i = next++; i < runs.size() && !stop; i = next++) {
        auto simulation = from;
        runs[i] = play(simulation, scene, *scripts[i], orders[i], [&] { return !stop; });
      }
    } catch (...) {
      why[worker] = std::current_exception();
      stop = true;
    }
    const std::lock_guard guard(lock);
    ++ended;
    one_ended.notify_one();
  };
  std::vector<std::jthread> workers;
  workers.reserve(threads);
  for (unsigned k = 0; k < threads; ++k) workers.emplace_back(work, k);
  {
    std::unique_lock guard(lock);
    while (!one_ended.wait_for(guard, kBetweenQuestions, [&] { return ended == threads; }))
      if (!stop && !go_on()) stop = true;
  }
  workers.clear();
  for (const auto& error : why)
    if (error) std::rethrow_exception(error);
  return runs;
}

}  // namespace ligature::python
