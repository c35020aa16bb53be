#pragma once
// Plays a script through the physics into memory, like `ligature-lab run` without its files.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::python {

/// Checked parameters of a run.
struct Orders {
  std::int64_t first_tick = 0;  ///< the script's tick that precedes the first one played
  std::int64_t ticks = 0;
  double shape_every_s = 0.02;
};

/// Results of a run. The rows have the columns of trace.csv without the last one, step_us.
struct Run {
  static constexpr std::size_t kColumns = 12;
  std::vector<double> trace;
  std::vector<double> shape_t_s;
  std::vector<double> shapes;  ///< n nodes x 3 coordinates per shape
  std::size_t nodes = 0;
  bool finite = true;
  std::string failure;  ///< empty, or the message of `ligature-lab run`
};

/// Parameters of `runs` equal runs. @throws lab::Refusal for invalid times, or when the results would not fit in
/// memory.
[[nodiscard]] Orders orders_of(const scene::Scene& scene, double start_s, double duration_s, double shape_every_s,
                               std::size_t runs);

/// Plays to the end, to the first non-finite tick, or until go_on() returns false (called every few ticks).
[[nodiscard]] Run play(physics::Simulation& simulation, const scene::Scene& scene, const scene::GripperScript& script,
                       const Orders& orders, const std::function<bool()>& go_on);

/// Plays each script on its own copy of `from`, in parallel on `threads` threads; bit-identical to serial runs.
/// @param go_on  called from the calling thread while it waits; false stops all runs.
[[nodiscard]] std::vector<Run> play_all(const physics::Simulation& from, const scene::Scene& scene,
                                        std::span<const scene::GripperScript* const> scripts,
                                        std::span<const Orders> orders, unsigned threads,
                                        const std::function<bool()>& go_on);

}  // namespace ligature::python
