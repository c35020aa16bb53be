#include "bridge/plugin_device.hpp"

#include <dlfcn.h>

#include <cmath>

#include "bridge/backend.h"
#include "protocol/can/device_profile.hpp"

namespace ligature::bridge {
namespace {

static_assert(LIGATURE_BUTTON_GRIP == can::profile::kButtonGrip);
static_assert(LIGATURE_BUTTON_DEAD_MAN == can::profile::kButtonDeadMan);
static_assert(LIGATURE_BUTTON_CLUTCH == can::profile::kButtonClutch);
constexpr unsigned kButtons = LIGATURE_BUTTON_GRIP | LIGATURE_BUTTON_DEAD_MAN | LIGATURE_BUTTON_CLUTCH;

class PluginDevice final : public Device {
 public:
  explicit PluginDevice(const ligature_backend& backend) : backend_(backend) {}
  ~PluginDevice() override { backend_.close(backend_.device); }

  std::optional<DeviceState> exchange(const Vec& force_D_N) override {
    ligature_backend_state state{};
    if (backend_.exchange(backend_.device, force_D_N.data(), &state) == 0) return std::nullopt;
    DeviceState read;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!std::isfinite(state.position_m[i])) return std::nullopt;
      read.p_D_m[i] = state.position_m[i];
    }
    read.buttons = static_cast<std::uint16_t>(state.buttons & kButtons);
    return read;
  }
  std::string problem() const override { return "the back-end has no state from the device"; }

 private:
  ligature_backend backend_;
};

}  // namespace

OpenedDevice open_plugin(const std::string& library, const std::string& address) {
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded as long as the program runs
  if (handle == nullptr) return std::string("--backend ") + dlerror();
  const auto open = reinterpret_cast<decltype(&ligature_backend_open)>(dlsym(handle, "ligature_backend_open"));
  if (open == nullptr) return "--backend " + library + ": found no function ligature_backend_open (bridge/backend.h)";
  ligature_backend backend{};
  std::array<char, 256> problem{};
  if (open(address.c_str(), &backend, problem.data(), static_cast<int>(problem.size()) - 1) == 0)
    return "--backend " + library + ": " + problem.data();
  if (backend.version != LIGATURE_BACKEND_VERSION || backend.exchange == nullptr || backend.close == nullptr)
    return "--backend " + library + ": found version " + std::to_string(backend.version) + ", allowed " +
           std::to_string(LIGATURE_BACKEND_VERSION) + " with exchange and close";
  return std::unique_ptr<Device>(std::make_unique<PluginDevice>(backend));
}

}  // namespace ligature::bridge
