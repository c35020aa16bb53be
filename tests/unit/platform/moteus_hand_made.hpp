#pragma once
// One hand with moteus drives whose frames a test makes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/platform/moteus_link.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {

inline constexpr std::uint8_t kOff = 0, kPreparing = 3, kFixedVoltage = 6, kOn = 10, kTimeout = 11;  // modes
using rt::DriveRequest;

inline std::vector<std::uint8_t> bytes_of(const can::Frame& f) { return {f.data.begin(), f.data.begin() + f.dlc}; }

/// An answer of the form that the query asks for.
inline can::Frame answer(unsigned node, std::uint8_t mode, float rev, moteus::Extra extra, float value,
                         std::uint8_t fault = 0, float torque_Nm = 0.0F) {
  can::Frame f{node << 8U,
               24,
               {0x21, 0x00, mode, 0x2D, 0x01, 0, 0, 0, 0, 0x2D, 0x03, 0, 0, 0, 0, 0x21, 0x0F, fault, 0x2D},
               can::Format::kFdFast};
  f.data[19] = moteus::kExtraRegister[static_cast<std::size_t>(extra)];
  for (const auto& [at, number] : {std::pair{5U, rev}, {11U, torque_Nm}, {20U, value}})
    for (unsigned i = 0; i < 4; ++i)
      f.data[at + i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(number) >> (8U * i));
  return f;
}

class Moteus : public ::testing::Test {
 protected:
  static constexpr int kWatchdog_ms = 20;
  /// What a healthy drive tells back.
  float told(moteus::Extra extra) const {
    if (extra == moteus::Extra::kHome) return 1.0F;
    if (extra == moteus::Extra::kMaxTorque) return static_cast<float>(device.max_torque_Nm());
    return extra == moteus::Extra::kWatchdog ? 0.02F : 0.0F;
  }
  /// The extra register of the queries that were sent last; nothing if nobody was asked.
  std::optional<moteus::Extra> asked() const {
    for (const can::Frame& f : bus.sent)
      for (std::size_t i = 0; i < moteus::kExtras; ++i)
        if (f == moteus::query(1, static_cast<moteus::Extra>(i))) return static_cast<moteus::Extra>(i);
    return std::nullopt;
  }
  /// The module answers the queries that were sent last.
  void press() {
    last_life = life.value_or(moteus::register_of(*asked()));
    bus.inbox.push_back({moteus::kButtonsId, 2, {2, last_life}});
  }
  /// One period in which the drives answer.
  rt::HandReading period(DriveRequest request, double torque_Nm = 0.0) {
    bus.sent.clear();
    link->request();
    if (const auto extra = asked()) {
      for (unsigned node = 1; node <= 3; ++node)
        bus.inbox.push_back(answer(node, mode[node - 1], rev, *extra, change ? change(node, *extra) : told(*extra),
                                   fault[node - 1], made_Nm));
      press();
    }
    link->drain();
    const auto reading = link->reading();
    bus.sent.clear();
    sent = link->write({{torque_Nm, torque_Nm, torque_Nm}, request});
    return reading;
  }
  rt::HandReading periods(int n, DriveRequest request, double torque_Nm = 0.0) {
    rt::HandReading r;
    for (int i = 0; i < n; ++i) r = period(request, torque_Nm);
    return r;
  }
  void set_modes(std::uint8_t m) { mode = {m, m, m}; }
  /// Until all drives are on and have told back their settings.
  void switch_on() {
    set_modes(kOff);
    periods(3, DriveRequest::kEnable);
    set_modes(kOn);
    ASSERT_TRUE(periods(8, DriveRequest::kEnable).enabled);
  }
  bool all_stopped() const {
    return bus.sent.size() == 3 &&
           std::ranges::all_of(bus.sent, [](const can::Frame& f) { return bytes_of(f) == bytes_of(moteus::stop(1)); });
  }
  FakeBus bus;
  device::Device device =
      std::get<device::Device>(device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/moteus.toml"));
  std::optional<MoteusLink> link{std::in_place, bus, device, kWatchdog_ms};
  std::array<std::uint8_t, 3> mode{}, fault{};
  std::function<float(unsigned, moteus::Extra)> change;  // of what the drives tell back
  float rev = 0.5F, made_Nm = 0.0F;
  std::uint8_t last_life = 0;
  std::optional<std::uint8_t> life;  // counter of a module that does not tell the register that was asked for
  std::array<std::int16_t, 3> sent{};
};

}  // namespace ligature::platform
