#include "firmware/app/rig_setup.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "firmware/app/launch.hpp"
#include "firmware/control/admissible.hpp"
#include "firmware/control/controller.hpp"
#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/socket_bus.hpp"
#include "firmware/rt/tick_record.hpp"
#include "protocol/device/device_file.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "protocol/scene/scene_file.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::app {
namespace {

/// Error text if the coupling is stiffer than the device can render stably, else empty.
std::string too_stiff(const scene::Hands& hands, const device::Device& device) {
  const auto a = control::admissible(hands, device, control::kPeriod_s);
  if (a.holds()) return {};
  std::ostringstream text;
  text << "coupling of " << a.K_N_per_m
       << " N/m at the device (hands.coupling_N_per_m, hands.device_N_per_m), allowed less than " << a.largest_N_per_m
       << " N/m: b " << device.damping_N_s_per_m << " + B " << a.B_N_s_per_m << " N s/m over T/2 + delay "
       << 1e3 * (0.5 * control::kPeriod_s + device.delay_s) << " ms of " << device.name
       << "; or --override-passivity (docs/haptics.md)";
  return text.str();
}

/// Error text if the scene has a setting that is allowed in a simulation, but not when hands are connected; else empty.
std::string objection(const scene::Scene& s, const device::Device& device) {
  const auto told = [](const char* key, double found, const std::string& allowed) {
    std::ostringstream text;
    text << "key '" << key << "': found " << found << ", allowed " << allowed << " when hands are connected";
    return text.str();
  };
  if (s.time.tick_s != control::kPeriod_s) return told("time.tick_s", s.time.tick_s, "0.001");
  if (s.hands.max_force_N > device.peak_force_N) {
    std::ostringstream most;
    most << "0 .. " << device.peak_force_N;
    return told("hands.max_force_N", s.hands.max_force_N, most.str());
  }
  return s.hands.override_passivity ? std::string() : too_stiff(s.hands, device);
}

/// Whether both URLs are equal, or name the same socket by different paths.
bool is_same_bus(const std::string& left, const std::string& right) {
  constexpr std::string_view kLocal = "local:";
  if (left.empty() || right.empty()) return false;  // `admit` opens no bus
  if (left == right) return true;
  if (!left.starts_with(kLocal) || !right.starts_with(kLocal)) return false;
  std::error_code none;
  const auto path = [&](const std::string& url) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(url.substr(kLocal.size()), none), none);
  };
  return path(left) == path(right);
}

std::variant<std::unique_ptr<platform::CanBus>, Refusal> open_patiently(const std::string& url, can::Network network,
                                                                        double wait_s, const Pause& pause) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(wait_s);
  for (;;) {
    auto opened = platform::open_can_bus(url, network);
    if (auto* bus = std::get_if<std::unique_ptr<platform::CanBus>>(&opened)) return std::move(*bus);
    const auto& error = std::get<platform::OpenError>(opened);
    if (error.kind == platform::OpenFailure::kUsage) return Refusal{2, error.text};
    if (error.kind == platform::OpenFailure::kTaken) return Refusal{3, error.text};
    if (pause() || std::chrono::steady_clock::now() >= give_up) return Refusal{3, error.text};
  }
}

}  // namespace

std::variant<Plan, Refusal> plan_of(const std::string& file, const std::string& text,
                                    const std::vector<std::string>& overrides, const device::Device& device) {
  auto loaded = scene::parse_scene(text, file, overrides);
  if (const auto* error = std::get_if<scene::Error>(&loaded)) return Refusal{2, error->text};
  auto& scene = std::get<scene::Scene>(loaded);
  if (const auto why = objection(scene, device); !why.empty()) return Refusal{2, file + ": " + why};
  auto made = physics::Simulation::make(scene);
  if (const auto* why = std::get_if<std::string>(&made)) return Refusal{2, file + ": " + *why};
  auto toml = scene::recorded_text(text, overrides, scene);
  scene::add_earliest_samples(toml, platform::bus_time_of(device).samples_earliest.count());
  return Plan{scene, std::move(std::get<physics::Simulation>(made)), device, std::move(toml)};
}

std::variant<Plan, Refusal> make_plan(const RunOptions& options) {
  if (!options.scenes.empty() && !std::filesystem::is_directory(options.scenes))
    return Refusal{2, "--scenes " + options.scenes + ": allowed a folder that is there"};
  device::Device device = device::omni();
  if (!options.device.empty()) {
    auto loaded = device::load_device(options.device);
    if (const auto* error = std::get_if<scene::Error>(&loaded)) return Refusal{2, error->text};
    device = std::get<device::Device>(loaded);
  }
  if (!options.accept_no_drive_watchdog && !platform::have_watchdog(device))
    return Refusal{2, (options.device.empty() ? device.name : options.device) +
                          ": the drives have no watchdog that is known to remove the torque if this program dies; "
                          "allowed only with --accept-no-drive-watchdog and an emergency stop in reach "
                          "(docs/drives.md)"};
  const auto text = scene::read_text(options.scene, scene::kMostScene_bytes);
  if (const auto* error = std::get_if<scene::Error>(&text)) return Refusal{2, error->text};
  auto plan = plan_of(options.scene, std::get<std::string>(text), launch_overrides(options), device);
  if (std::holds_alternative<Refusal>(plan)) return plan;
  if (is_same_bus(options.left, options.right))
    return Refusal{2, "--left, --right: found '" + options.left + "' for both, allowed a bus for each hand"};
  return plan;
}

void give_work(Plan& plan, long instructions) {
  auto& own = plan.scene.suture.rod.work_instructions;
  if (instructions == 0 || own != 0) return;
  own = static_cast<int>(instructions);
  plan.thread.set_work(instructions);
  plan.toml += "\n# --set suture.work_instructions=" + std::to_string(instructions);
}

std::variant<Buses, Refusal> open_buses(const RunOptions& options, const device::Device& device, const Pause& pause) {
  Buses buses;
  for (auto [url, bus] : {std::pair{&options.left, &buses.left}, std::pair{&options.right, &buses.right}}) {
    auto opened = open_patiently(*url, platform::network_of(device), options.wait_s, pause);
    if (auto* refusal = std::get_if<Refusal>(&opened)) return *refusal;
    *bus = std::move(std::get<0>(opened));
  }
  buses.drives = {platform::make_drives(*buses.left, device, options.watchdog_ms, 0),
                  platform::make_drives(*buses.right, device, options.watchdog_ms, 1)};
  return buses;
}

std::optional<Refusal> configure(const Buses& buses) {
  constexpr std::array kNames{"left", "right"};
  const std::array bus{buses.left.get(), buses.right.get()};
  const auto told = [&](std::size_t h, const std::string& why) { return std::string(kNames[h]) + " hand: " + why; };
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    // Waits on this hand's bus only: unread frames of the other bus would end the wait too early
    platform::PollWait alone(*bus[h], *bus[h]);
    if (const auto why = buses.drives[h]->other_controller(alone)) return Refusal{3, told(h, *why)};
  }
  platform::PollWait wait(*buses.left, *buses.right);
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    const auto why = buses.drives[h]->configure(wait);
    if (!why) continue;
    const std::size_t other = 1 - h;
    platform::PollWait alone(*bus[other], *bus[other]);
    const auto still_on = buses.drives[other]->release(alone);
    return Refusal{3, told(h, *why) + (still_on ? "; " + told(other, *still_on) : "")};
  }
  return std::nullopt;
}

}  // namespace ligature::app
