#pragma once
// A script played through the physics into memory: what `ligature-lab run` does, without its files.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::python {

/// What is to be played, checked.
struct Orders {
  std::int64_t first_tick = 0;  ///< of the script, before the first one that is played
  std::int64_t ticks = 0;
  double shape_every_s = 0.02;
};

/// What came of it. Rows have the columns of trace.csv but for the last one, step_us.
struct Run {
  static constexpr std::size_t kColumns = 12;
  std::vector<double> trace;
  std::vector<double> shape_t_s;
  std::vector<double> shapes;  ///< nodes after nodes, x, y, z
  std::size_t nodes = 0;
  bool finite = true;
  std::string failure;  ///< empty, or the line of `ligature-lab run`
};

/// Orders of a run, of `runs` of them at once. @throws lab::Refusal for times that make no sense or fill the memory.
[[nodiscard]] Orders orders_of(const scene::Scene& scene, double start_s, double duration_s, double shape_every_s,
                               std::size_t runs);

/// Plays to the end, to the first tick that is no number, or until go_on() says no (asked now and then).
[[nodiscard]] Run play(physics::Simulation& simulation, const scene::Scene& scene, const scene::GripperScript& script,
                       const Orders& orders, const std::function<bool()>& go_on);

/// Each script on a copy of its own, on so many threads; as play() one after the other, to the bit.
/// @param go_on  asked from the calling thread while it waits.
[[nodiscard]] std::vector<Run> play_all(const physics::Simulation& from, const scene::Scene& scene,
                                        std::span<const scene::GripperScript* const> scripts,
                                        std::span<const Orders> orders, unsigned threads,
                                        const std::function<bool()>& go_on);

}  // namespace ligature::python
