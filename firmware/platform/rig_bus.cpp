#include "firmware/platform/rig_bus.hpp"

namespace ligature::platform {

void RigBus::send_sync() noexcept {
  for (HandLink& hand : hands_) hand.send_sync();
}

rt::RigReading RigBus::read_tpdos(Nanoseconds deadline) noexcept {
  const auto settled = [this] { return hands_[0].is_settled() && hands_[1].is_settled(); };
  const auto drain = [this] {
    for (HandLink& hand : hands_) hand.drain();
  };
  for (drain(); !settled() && wait_.wait(deadline);) drain();
  return {{hands_[0].reading(), hands_[1].reading()}};
}

rt::WireTorque RigBus::write_rpdos(const rt::RigCommand& command) noexcept {
  return {hands_[0].write(command.hand[0]), hands_[1].write(command.hand[1])};
}

}  // namespace ligature::platform
