#pragma once
// Builds what the command line names: scene, buses, configured drives.

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "firmware/app/options.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/platform/hand_drives.hpp"
#include "protocol/device/device.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::app {

/// Why the program cannot start, and its exit code.
struct Refusal {
  int exit_code;
  std::string text;
};

struct Plan {
  scene::Scene scene;
  physics::Simulation thread;
  device::Device device;
  std::string toml;  ///< the scene's text with the overrides as comments, stored in recordings
};
[[nodiscard]] std::variant<Plan, Refusal> make_plan(const RunOptions& options);
/// As make_plan(), for a scene whose text was already read from `file`. Callers that load a scene during a run use only
/// the text of a Refusal, not its exit code.
[[nodiscard]] std::variant<Plan, Refusal> plan_of(const std::string& file, const std::string& text,
                                                  const std::vector<std::string>& overrides,
                                                  const device::Device& device = device::omni());

/// Sets the thread's contact budget per tick and adds it to the overrides, so that a replay of the recording gives the
/// same motion. Does nothing if `instructions` is 0 (a model without budget) or the scene sets its own budget.
void give_work(Plan& plan, long instructions);

/// Both hands' buses, and the drives on them.
struct Buses {
  std::unique_ptr<platform::CanBus> left, right;
  std::array<std::unique_ptr<platform::HandDrives>, rt::kHands> drives;
};

/// Pauses for a moment. @return true if the program shall end.
using Pause = std::function<bool()>;

/// Opens both buses. Retries for options.wait_s, because a hand's device may be switched on later than this program.
[[nodiscard]] std::variant<Buses, Refusal> open_buses(const RunOptions& options, const device::Device& device,
                                                      const Pause& pause);

/// Checks that no other controller commands the drives of either hand; until then nothing is sent. Then sets all six
/// drives up. If one hand's are refused, those of the other hand are switched off too: they may act from an earlier
/// run.
/// @return why it failed, if so, and which drives do not say that they are off.
[[nodiscard]] std::optional<Refusal> configure(const Buses& buses);

}  // namespace ligature::app
