// Load of the bus with the drives of each shipped record, and the time from a sample until the torque that was computed
// from it acts. Measured on the simulated bus, with the frames that the controller sends, and drives that answer at
// once. The contents are random, because they decide the number of stuff bits. docs/drives.md has the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "firmware/platform/make_drives.hpp"
#include "firmware/platform/moteus_frames.hpp"
#include "firmware/platform/moteus_time.hpp"
#include "firmware/platform/odrive_frames.hpp"
#include "firmware/platform/odrive_time.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/can/cia402.hpp"
#include "protocol/can/codec.hpp"
#include "protocol/can/nmt.hpp"
#include "protocol/can/remote.hpp"
#include "protocol/device/device_file.hpp"
#include "sim_device/wire.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::platform {
namespace {

using sim::Time;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int kController = 0, kDrives = 3, kButtons = 4;  // senders on the wire; 1 to 3 are the drives
constexpr Time kComputing = microseconds(35);

device::Device shipped_record(const std::string& file) {
  return std::get<device::Device>(device::load_device(std::string(LIGATURE_SOURCE_DIR) + "/scenes/devices/" + file));
}

struct Figures {
  double load = 0.0;                 ///< share of the time
  Time least = Time::max(), most{};  ///< from a sample to the effect of its torque
  int periods_without_set = 0;
  int late = 0;  ///< SYNCs at which a torque of the period before had not arrived
};

class BusOfARecord {
 public:
  explicit BusOfARecord(const std::string& file)
      : device_(shipped_record(file)), drives_(make_drives(bus_, device_, 20, 0)) {
    bus_.on_send = [this](const can::Frame& frame) { wire_.submit(frame, kController, now_); };
  }

  Figures run(int periods) {
    for (int k = 0; k < periods; ++k) {
      const Time begin = milliseconds(k);
      now_ = begin;
      send_by_timers(k);
      drives_->request();
      std::optional<Time> write_at;
      bool has_written = false;
      for (; now_ < begin + milliseconds(1); now_ += microseconds(1)) {
        while (const auto heard = wire_.advance(now_)) hear(*heard);
        drives_->drain();
        if (!write_at && drives_->is_settled()) write_at = now_ + kComputing;
        if (has_written || !write_at || now_ < *write_at) continue;
        has_written = true;
        const bool switches_on = device_.moteus && k < 30;
        drives_->write(
            {{torque(), torque(), torque()}, switches_on ? rt::DriveRequest::kEnable : rt::DriveRequest::kOperate});
      }
      // The first frame of ODrives' buttons is no sample: there is no counter before it
      figures_.periods_without_set += has_written || k == 0 ? 0 : 1;
    }
    figures_.load = std::chrono::duration<double>(wire_.stats().busy) / std::chrono::duration<double>(now_);
    return figures_;
  }

 private:
  double torque() { return random_.in(-0.5, 0.5); }

  void hear(const sim::Transmission& heard) {
    if (heard.sender != kController) return bus_.inbox.push_back(heard.frame);
    if (device_.moteus) return hear_as_moteus(heard);
    device_.odrive ? hear_as_odrive(heard) : hear_as_cia402(heard);
  }

  void hear_as_cia402(const sim::Transmission& heard) {
    const auto address = can::address_of(heard.frame.id);
    torques_ += address && address->service == can::Service::kRpdo1;
    if (!can::is_sync(heard.frame)) return;
    // At this SYNC the drives sample, and the torques that arrived since the last SYNC begin to act. These torques were
    // computed from the samples of the last SYNC, because the controller writes only when it has all samples.
    if (sampled_[0] > Time(0) && torques_ == kDrives) note(heard.end - sampled_[0]);
    figures_.late += sampled_[0] > Time(0) && torques_ != kDrives;
    torques_ = 0;
    sampled_[0] = heard.end;
    for (const can::NodeId node : can::profile::kJointNodes)
      wire_.submit(can::encode(node, can::Tpdo1{can::cia402::statusword_of(can::cia402::State::kOperationEnabled),
                                                static_cast<std::int32_t>(random_.any(-8000, 8000)), 300, 2}),
                   node.value, heard.end);
    for (const can::Frame& sample : drives_->example_samples())
      if (sample.dlc < 8) wire_.submit(sample, 3, heard.end);  // the inputs, by node 3
  }

  /// A drive samples when it is asked, and a torque acts when it arrives.
  void hear_as_odrive(const sim::Transmission& heard) {
    const auto address = odrive::address_of(heard.frame.id & can::kMaxId);
    if (!address) return;
    if (can::is_remote(heard.frame)) {
      sampled_[address->joint] = heard.end;
      can::Frame f{heard.frame.id & can::kMaxId, 8, {}};
      for (std::size_t i = 0; i < 3; ++i) f.data[i] = static_cast<std::uint8_t>(random_.any(0, 255));
      f.data[3] = 0x3F;  // a number near 1
      wire_.submit(f, static_cast<int>(address->joint) + 1, heard.end);
      if (address->joint == 2) wire_.submit({device_.odrive->buttons_id, 2, {2, ++life_}}, kButtons, heard.end);
    } else if (address->command == odrive::Command::kSetInputTorque) {
      note(heard.end - sampled_[address->joint]);
    }
  }

  /// The same; the drives tell back what they were commanded.
  void hear_as_moteus(const sim::Transmission& heard) {
    const std::size_t joint = (heard.frame.id & 3U) - 1;
    if (heard.frame.dlc == moteus::kTorqueBytes) {
      is_on_ = true;
      return note(heard.end - sampled_[joint]);
    }
    if (heard.frame.dlc != moteus::kQueryBytes) return;  // a stop
    sampled_[joint] = heard.end;
    can::Frame f{static_cast<std::uint32_t>(joint + 1) << 8U,
                 24,
                 {0x21, 0x00, 0, 0x2D, 0x01, 0, 0, 0, 0x3F, 0x2D, 0x03},
                 can::Format::kFdFast};
    f.data[2] = is_on_ ? 10 : 0;
    for (const std::size_t at : {5U, 6U, 7U, 11U, 12U, 13U})
      f.data[at] = static_cast<std::uint8_t>(random_.any(0, 255));
    f.data[15] = 0x21, f.data[16] = 0x0F, f.data[18] = 0x2D;
    const std::uint8_t reg = f.data[19] = heard.frame.data[9];
    const float value = reg == 0x0C ? 1.0F : reg == 0x25 ? 0.9F : reg == 0x27 ? 0.02F : 0.0F;
    for (unsigned i = 0; i < 4; ++i)
      f.data[20 + i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(value) >> (8U * i));
    wire_.submit(f, static_cast<int>(joint) + 1, heard.end);
    if (joint == 2) wire_.submit({moteus::kButtonsId, 2, {2, reg}}, kButtons, heard.end);
  }

  /// Heartbeats of ODrives, at phases of their own.
  void send_by_timers(int k) {
    if (!device_.odrive) return;
    for (int node = 1; node <= 3; ++node) {
      if (k % device_.odrive->heartbeat_ms != 3 * node) continue;
      can::Frame f{odrive::id_of(static_cast<unsigned>(node), odrive::Command::kHeartbeat), 8, {}};
      f.data[4] = odrive::kClosedLoop;
      wire_.submit(f, node, now_ + microseconds(200 * node));
    }
  }

  void note(Time delay) {
    figures_.least = std::min(figures_.least, delay);
    figures_.most = std::max(figures_.most, delay);
  }

  Time now_{};
  sim::Wire wire_;
  FakeBus bus_;
  device::Device device_;
  std::unique_ptr<HandDrives> drives_;
  test::Random random_{71};
  std::array<Time, 3> sampled_{};
  std::uint8_t life_ = 0;
  bool is_on_ = false;
  int torques_ = 0;  // frames with a torque since the last SYNC
  Figures figures_;
};

/// A row of the table in docs/drives.md.
struct PageRow {
  const char* name;
  std::vector<const char*> files;
  double load;            // what is measured, like the two times
  Time least, most;       // from a sample to its torque
  const char* more = "";  // about the torques
};

const PageRow kPageRows[] = {
    {"our own, and the bridge's", {"omni.toml", "inverse3.toml"}, 0.666, microseconds(1000), microseconds(1000)},
    {"`epos4.toml`", {"epos4.toml"}, 0.738, microseconds(1000), microseconds(1000)},
    {"`generic-cia402.toml`", {"generic-cia402.toml"}, 0.757, microseconds(1000), microseconds(1000)},
    {"`odrive.toml`", {"odrive.toml"}, 0.860, microseconds(430), microseconds(885), ", may pass into the next period"},
    {"`moteus.toml`", {"moteus.toml"}, 0.830, microseconds(559), microseconds(595), ", may pass into the next period"},
};

std::chrono::nanoseconds torques_time(const device::Device& d) {
  if (d.odrive) return odrive_torques_time();
  return d.moteus ? moteus_torques_time() : bus_time_of(d).torques_latest;
}

/// Two bounds, the lower one rounded down, the upper one up.
std::string between(double low, double high, const char* format) {
  std::array<char, 32> a{}, b{};
  std::snprintf(a.data(), a.size(), format, low);
  std::snprintf(b.data(), b.size(), format, high);
  return std::string(a.data()) == b.data() ? a.data() : std::string(a.data()) + " to " + b.data();
}

std::string page_text(const PageRow& row, double least_load, double most_load, const Figures& f) {
  const device::Device d = shipped_record(row.files[0]);
  const rt::BusTime time = bus_time_of(d);
  const auto us = [](Time t) { return 1e-3 * static_cast<double>(t.count()); };
  const auto hundredths = [&](Time t) { return us(t) * 1e-1; };
  return std::string("| ") + row.name + " | " +
         between(std::floor(us(time.samples_earliest)), std::ceil(us(time.samples_latest)), "%.0f") + " us | at most " +
         std::to_string(std::lround(std::ceil(us(torques_time(d))))) + " us" + row.more + " | " +
         std::to_string(std::lround(std::floor(us(time.most_work())))) + " us | " +
         between(100.0 * least_load, 100.0 * most_load, "%.0f") + " % | " +
         between(1e-2 * std::floor(hundredths(f.least)), 1e-2 * std::ceil(hundredths(f.most)), "%.2f") + " ms |\n";
}

TEST(DriveBus, LoadAndDelayOfEachRecord) {
  constexpr double kShare = 0.03;
  std::ostringstream page;
  page << std::ifstream(std::string(LIGATURE_SOURCE_DIR) + "/docs/drives.md").rdbuf();
  for (const PageRow& row : kPageRows) {
    double least_load = 1.0, most_load = 0.0;
    Figures f;
    for (const char* file : row.files) {
      f = BusOfARecord(file).run(2000);
      const auto us = [](Time t) { return 1e-3 * static_cast<double>(t.count()); };
      std::printf("%-20s load %.1f %%, sample to torque %.1f to %.1f us, %d periods without a set, %d late\n", file,
                  100.0 * f.load, us(f.least), us(f.most), f.periods_without_set, f.late);
      EXPECT_NEAR(f.load, row.load, kShare * row.load) << file;
      EXPECT_NEAR(us(f.least), us(row.least), kShare * us(row.least)) << file;
      EXPECT_NEAR(us(f.most), us(row.most), kShare * us(row.most)) << file;
      EXPECT_EQ(f.periods_without_set, 0) << file;
      EXPECT_EQ(f.late, 0) << file;
      least_load = std::min(least_load, f.load), most_load = std::max(most_load, f.load);
    }
    if (test::seed_shift() != 0) continue;  // the page shows results without a seed shift
    const std::string text = page_text(row, least_load, most_load, f);
    EXPECT_NE(page.str().find(text), std::string::npos) << "docs/drives.md is old; its row is\n" << text;
  }
}

}  // namespace
}  // namespace ligature::platform
