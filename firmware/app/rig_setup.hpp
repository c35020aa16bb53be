#pragma once
// From names on the command line to things that work: the scene, the buses, the drives.

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "firmware/app/options.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/platform/can_bus.hpp"
#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// Why something could not be, and the exit code that says so.
struct Refusal {
  int exit_code;
  std::string text;
};

struct Plan {
  scene::Scene scene;
  physics::Simulation thread;
  device::Device device;
  std::string toml;  ///< the scene's text with the overrides as comments, for recordings
};
[[nodiscard]] std::variant<Plan, Refusal> make_plan(const RunOptions& options);
/// The same for any scene: one that was read from `file`. Exit codes do not matter then.
[[nodiscard]] std::variant<Plan, Refusal> plan_of(const std::string& file, const std::string& text,
                                                  const std::vector<std::string>& overrides,
                                                  const device::Device& device = device::omni());

/// Gives the plan's thread so much work for contact a tick, and notes it with the overrides, so that a recording is
/// stepped again alike. Nothing for a thread without such a bound (0), or whose scene says it.
void give_work(Plan& plan, long instructions);

struct Buses {
  std::unique_ptr<platform::CanBus> left, right;
};

/// Pauses for a while; true when the program shall end.
using Pause = std::function<bool()>;

/// Opens both buses, trying again for options.wait_s: a hand may start later than we.
[[nodiscard]] std::variant<Buses, Refusal> open_buses(const RunOptions& options, const Pause& pause);

/// Makes sure that nobody else commands the drives, then start-up of all six up to pre-operational. @return why not.
[[nodiscard]] std::optional<Refusal> configure(const Buses& buses, const RunOptions& options,
                                               const device::Device& device);

}  // namespace ligature::app
