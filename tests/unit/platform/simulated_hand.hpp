#pragma once
// One hand with three simulated drives that answer requests, and a button module, in simulated time.

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "firmware/platform/hand_drives.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/can/remote.hpp"
#include "protocol/device/device_file.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {

/// A module that answers the request to drive 3.
struct Buttons {
  std::uint32_t request = 0, id = 0;
  std::uint8_t bits = 2, life = 0;
  bool answers = true, counts = true;
  bool echoes = false;  // its counter is the register that was asked for
  void take(const can::Frame& frame, std::deque<can::Frame>& inbox) {
    if (!answers || frame.id != request) return;
    if (counts) life = static_cast<std::uint8_t>(echoes ? frame.data[9] : life + 1);
    inbox.push_back({id, 2, {bits, life}});
  }
};

/// The controller's side is real; drives, module and time are simulated. Frames take no time on the bus.
template <class Node, class Drives>
class SimulatedHand {
 public:
  SimulatedHand(const std::string& record, const Buttons& module)
      : device(std::get<device::Device>(
            device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/" + record))),
        buttons(module) {
    bus.on_send = [this](const can::Frame& frame) {
      if (is_cut) return;
      for (auto& node : nodes) node.take(frame, wait.time);
      buttons.take(frame, bus.inbox);
      deliver();
    };
    wait.on_wait = [this] { advance(); };
  }
  void advance() {
    for (auto& node : nodes) node.advance(wait.time);
    deliver();
    most_Nm = std::max(most_Nm, torque());
  }
  void deliver() {
    for (auto& node : nodes) {
      if (!is_cut) bus.inbox.insert(bus.inbox.end(), node.out.begin(), node.out.end());
      node.out.clear();
    }
  }
  float torque() const {
    float most = 0.0F;
    for (const auto& node : nodes) most = std::max(most, std::abs(node.torque_Nm()));
    return most;
  }
  bool is_off() const { return std::ranges::none_of(nodes, &Node::is_on); }
  std::string start() { return drives.configure(wait).value_or("accepted"); }

  /// One period of the loop.
  rt::HandReading period(rt::DriveRequest request, double torque_Nm = 0.0) {
    drives.request();
    const Nanoseconds end = wait.time + std::chrono::milliseconds(1);
    while (wait.time < end) {
      wait.wait(end);
      drives.drain();
    }
    const auto reading = drives.reading();
    drives.write({{torque_Nm, torque_Nm, torque_Nm}, request});
    return reading;
  }
  /// Periods until the drives are enabled. @return whether they are
  bool enable(int periods = 200) {
    for (int i = 0; i < periods; ++i) {
      const auto r = period(rt::DriveRequest::kEnable);
      if (r.enabled && !r.drive_fault && r.age_ticks == 0) return true;
    }
    return false;
  }

  FakeBus bus;
  FakeWait wait;
  device::Device device;
  std::vector<Node> nodes;
  Buttons buttons;
  Drives drives{bus, device, 20};
  float most_Nm = 0.0F;
  bool is_cut = false;  // the cable between the controller and the drives
};

}  // namespace ligature::platform
