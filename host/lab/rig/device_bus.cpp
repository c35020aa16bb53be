#include "host/lab/rig/device_bus.hpp"

#include "protocol/can/cob_id.hpp"

namespace ligature::lab {

bool DeviceBus::loses(const can::Frame& frame) noexcept {
  if (lost_share_ <= 0.0) return false;
  const auto address = can::address_of(frame.id);
  if (!address || (address->service != can::Service::kRpdo1 && address->service != can::Service::kTpdo1)) return false;
  // A uniform number in 0 .. 1 from the generator's upper 53 bits; the standard library's distributions differ between
  // platforms.
  const bool lost = static_cast<double>(random_() >> 11) * 0x1p-53 < lost_share_;
  frames_lost += lost;
  return lost;
}

bool DeviceBus::send(const can::Frame& frame) noexcept {
  if (cut || device.pending(sim::HandDevice::kFirstClient) >= kQueue) return false;
  if (!loses(frame)) device.submit(frame, sim::HandDevice::kFirstClient, now_);
  return true;
}

platform::Receive DeviceBus::receive(can::Frame& frame) noexcept {
  if (cut) return platform::Receive::kLost;
  device.advance(now_);
  if (faults) faults->apply(device, now_);
  auto& out = device.deliveries();
  while (!out.empty() && out.front().due <= now_) {
    const sim::Delivery first = out.front();
    out.erase(out.begin());
    if (first.sender == sim::HandDevice::kFirstClient) continue;  // a sender does not receive its own frames
    if (loses(first.frame)) continue;
    frame = first.frame;
    return platform::Receive::kFrame;
  }
  return platform::Receive::kNothing;
}

}  // namespace ligature::lab
