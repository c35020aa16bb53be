// Fuzz target: CAN frames from a hand's bus, for every decoder and for HandLink, which reads the bus in each tick.
#include <algorithm>
#include <cstring>
#include <deque>

#include "firmware/platform/hand_link.hpp"
#include "protocol/can/emcy.hpp"
#include "protocol/can/heartbeat.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/sdo.hpp"
#include "tests/fuzz/target.hpp"

namespace ligature {
namespace {

class QueueBus final : public platform::CanBus {
 public:
  bool send(const can::Frame&) noexcept override { return true; }
  platform::Receive receive(can::Frame& frame) noexcept override {
    if (frames.empty()) return platform::Receive::kNothing;
    frame = frames.front();
    frames.pop_front();
    return platform::Receive::kFrame;
  }
  [[nodiscard]] bool is_lost() const noexcept override { return false; }
  [[nodiscard]] int descriptor() const noexcept override { return -1; }
  std::deque<can::Frame> frames;
};

constexpr std::size_t kImage = 13;  // bytes per frame: identifier 4, length 1, data 8

std::string image(const can::Frame& f) {
  std::string s(kImage, '\0');
  std::memcpy(s.data(), &f.id, 4);
  s[4] = static_cast<char>(f.dlc);
  std::memcpy(s.data() + 5, f.data.data(), 8);
  return s;
}

}  // namespace

std::vector<std::string> fuzz::seeds() {
  std::string all;
  for (const auto node : can::profile::kJointNodes) {
    all += image(can::encode(node, can::Tpdo1{0x1237, 1000, 5, 0}));
    all += image(can::encode(can::Heartbeat{node, can::NmtState::kOperational}));
    all += image(can::encode(can::Emergency{node, 0x8130, 1}));
  }
  return {all};
}

}  // namespace ligature

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ligature;
  QueueBus bus;
  platform::HandLink link(bus, device::omni());
  for (; size >= kImage; data += kImage, size -= kImage) {
    can::Frame f{};
    std::memcpy(&f.id, data, 4);
    f.dlc = std::min<std::uint8_t>(data[4], 8);
    std::memcpy(f.data.data(), data + 5, 8);
    (void)can::decode_nmt(f);
    (void)can::decode_sdo(f);
    bus.frames.push_back(f);
    link.send_sync();
    link.drain();
    const auto reading = link.reading();
    (void)link.write({{0.1, 0.2, reading.q_rad[0]}, rt::DriveRequest::kEnable});
  }
  return 0;
}
