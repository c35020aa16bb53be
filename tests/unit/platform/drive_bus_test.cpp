// What the drives of each shipped record load their bus with, and how long a
// torque takes from the sample that it was computed from: measured on the
// simulated bus, with the frames that the controller sends and drives that
// answer at once. The contents are random, because they decide the number of
// stuff bits. docs/drives.md has the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>

#include "firmware/platform/make_drives.hpp"
#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/device/device_file.hpp"
#include "sim_device/wire.hpp"
#include "tests/support/random.hpp"

namespace ligature::platform {
namespace {

using sim::Time;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int kController = 0;  // sender on the wire; 1 to 3 are the drives
constexpr Time kComputing = microseconds(35);

/// The controller's end of the wire.
class WireBus final : public CanBus {
 public:
  WireBus(sim::Wire& wire, const Time& now) : wire_(wire), now_(now) {}
  bool send(const can::Frame& frame) noexcept override {
    wire_.submit(frame, kController, now_);
    return true;
  }
  Receive receive(can::Frame& frame) noexcept override {
    if (inbox.empty()) return Receive::kNothing;
    frame = inbox.front();
    inbox.pop_front();
    return Receive::kFrame;
  }
  [[nodiscard]] bool is_lost() const noexcept override { return false; }
  [[nodiscard]] int descriptor() const noexcept override { return -1; }
  std::deque<can::Frame> inbox;

 private:
  sim::Wire& wire_;
  const Time& now_;
};

struct Figures {
  double load = 0.0;                 ///< share of the time
  Time least = Time::max(), most{};  ///< from a sample to the effect of its torque
  int periods_without_set = 0;
};

class BusOfARecord {
 public:
  explicit BusOfARecord(const std::string& file)
      : device_(std::get<device::Device>(
            device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/" + file))),
        drives_(make_drives(bus_, device_, 20, 0)) {}

  Figures run(int periods) {
    for (int k = 0; k < periods; ++k) {
      const Time begin = milliseconds(k);
      now_ = begin;
      drives_->request();
      std::optional<Time> write_at;
      bool has_written = false;
      for (; now_ < begin + milliseconds(1); now_ += microseconds(1)) {
        while (const auto heard = wire_.advance(now_)) hear(*heard);
        drives_->drain();
        if (!write_at && drives_->is_settled()) write_at = now_ + kComputing;
        if (has_written || !write_at || now_ < *write_at) continue;
        has_written = true;
        drives_->write({{torque(), torque(), torque()}, rt::DriveRequest::kOperate});
      }
      figures_.periods_without_set += has_written ? 0 : 1;
    }
    figures_.load = std::chrono::duration<double>(wire_.stats().busy) / std::chrono::duration<double>(now_);
    return figures_;
  }

 private:
  double torque() { return random_.in(-0.5, 0.5); }

  void hear(const sim::Transmission& heard) {
    if (heard.sender != kController) return bus_.inbox.push_back(heard.frame);
    hear_as_cia402(heard);
  }

  /// At SYNC the drives sample, and the torques of the period before act.
  void hear_as_cia402(const sim::Transmission& heard) {
    if (!can::is_sync(heard.frame)) return;
    if (sampled_ > Time(0)) note(heard.end - sampled_);
    sampled_ = heard.end;
    for (const can::NodeId node : can::profile::kJointNodes)
      wire_.submit(can::encode(node, can::Tpdo1{can::cia402::statusword_of(can::cia402::State::kOperationEnabled),
                                                static_cast<std::int32_t>(random_.any(-8000, 8000)), 300, 2}),
                   node.value, heard.end);
    for (const can::Frame& sample : drives_->example_samples())
      if (sample.dlc < 8) wire_.submit(sample, 3, heard.end);  // the inputs, by node 3
  }

  void note(Time delay) {
    figures_.least = std::min(figures_.least, delay);
    figures_.most = std::max(figures_.most, delay);
  }

  Time now_{};
  sim::Wire wire_;
  WireBus bus_{wire_, now_};
  device::Device device_;
  std::unique_ptr<HandDrives> drives_;
  test::Random random_{71};
  Time sampled_{};
  Figures figures_;
};

TEST(DriveBus, LoadAndDelayOfEachRecord) {
  struct Row {
    const char* file;
    double most_load;
    Time least, most;
  };
  const Row rows[] = {{"omni.toml", 0.70, microseconds(990), microseconds(1010)},
                      {"epos4.toml", 0.77, microseconds(990), microseconds(1010)},
                      {"generic-cia402.toml", 0.79, microseconds(990), microseconds(1010)},
                      {"inverse3.toml", 0.70, microseconds(990), microseconds(1010)}};
  for (const Row& row : rows) {
    const Figures f = BusOfARecord(row.file).run(2000);
    const auto us = [](Time t) { return static_cast<long>(t.count() / 1000); };
    std::printf(
        "%-20s load %.1f %%, sample to torque %ld to %ld us, %d "
        "periods without a set\n",
        row.file, 100.0 * f.load, us(f.least), us(f.most), f.periods_without_set);
    EXPECT_GT(f.load, 0.6) << row.file;
    EXPECT_LT(f.load, row.most_load) << row.file;
    EXPECT_GE(f.least, row.least) << row.file;
    EXPECT_LE(f.most, row.most) << row.file;
    EXPECT_EQ(f.periods_without_set, 0) << row.file;
  }
}

}  // namespace
}  // namespace ligature::platform
