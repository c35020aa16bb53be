#include "firmware/platform/rig_bus.hpp"

#include <algorithm>

namespace ligature::platform {

void RigBus::request() noexcept {
  for (HandDrives* hand : hands_) hand->request();
}

rt::RigReading RigBus::read(Nanoseconds deadline) noexcept {
  const auto settled = [this] { return hands_[0]->is_settled() && hands_[1]->is_settled(); };
  const auto drain = [this] {
    for (HandDrives* hand : hands_) hand->drain();
  };
  for (drain(); !settled() && wait_.wait(deadline);) drain();
  return {{hands_[0]->reading(), hands_[1]->reading()}};
}

rt::WireTorque RigBus::write(const rt::RigCommand& command) noexcept {
  return {hands_[0]->write(command.hand[0]), hands_[1]->write(command.hand[1])};
}

rt::BusTime RigBus::bus_time() const noexcept {
  const rt::BusTime a = hands_[0]->bus_time(), b = hands_[1]->bus_time();
  return {std::max(a.samples_earliest, b.samples_earliest), std::max(a.samples_latest, b.samples_latest),
          std::max(a.torques_latest, b.torques_latest)};
}

}  // namespace ligature::platform
