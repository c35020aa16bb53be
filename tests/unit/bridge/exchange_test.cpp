// The thread that exchanges messages with a device: which force it sends, and how long a force waits.
#include "bridge/exchange.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "sim_device/event_loop.hpp"

namespace ligature::bridge {
namespace {

using sim::now_monotonic;
using std::chrono::milliseconds, std::chrono::seconds;

/// What the test shares with its device, each of whose exchanges ends when the test lets it.
class Gate {
 public:
  void pass(const Vec& force) {
    std::unique_lock lock(mutex_);
    forces_.push_back(force);
    changed_.notify_all();
    changed_.wait(lock, [&] { return let_through_ >= forces_.size(); });
  }
  void wait_for_exchange(std::size_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return forces_.size() >= number; });
  }
  void let_through(std::size_t exchanges) {
    const std::scoped_lock lock(mutex_);
    let_through_ = exchanges;
    changed_.notify_all();
  }
  std::vector<Vec> forces() {
    const std::scoped_lock lock(mutex_);
    return forces_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Vec> forces_;
  std::size_t let_through_ = 0;
};

class GatedDevice final : public Device {
 public:
  GatedDevice(Gate& gate, bool answers) : gate_(gate), answers_(answers) {}
  std::optional<DeviceState> exchange(const Vec& force_D_N) override {
    gate_.pass(force_D_N);
    return answers_ ? std::optional(DeviceState{}) : std::nullopt;
  }
  [[nodiscard]] std::string problem() const override { return "closed"; }

 private:
  Gate& gate_;
  bool answers_;
};

constexpr Vec kForce{1.0, 2.0, 3.0}, kOther{3.0, 2.0, 1.0};
constexpr std::size_t kEveryLater = 1'000'000;

/// A force that comes during exchange 1 leaves with exchange 2, and has waited until the end of that one.
TEST(BridgeExchange, AForceWaitsForTheEndOfTheExchangeThatTakesIt) {
  Gate gate;
  Exchange exchange(std::make_unique<GatedDevice>(gate, true), milliseconds(1), seconds(60));
  gate.wait_for_exchange(1);
  const Nanoseconds before = now_monotonic();
  exchange.set_force(kForce, before);
  gate.let_through(1);
  gate.wait_for_exchange(2);
  EXPECT_EQ(exchange.force_waits().forces, 0) << "the device does not have it yet";
  const Nanoseconds taken = now_monotonic();
  gate.let_through(2);
  gate.wait_for_exchange(3);
  const ForceWaits waits = exchange.force_waits();
  EXPECT_EQ(waits.forces, 1);
  EXPECT_GE(waits.worst, taken - before);
  EXPECT_LE(waits.worst, now_monotonic() - before);
  EXPECT_EQ(waits.sum, waits.worst);
  EXPECT_EQ(gate.forces().at(0), Vec{});
  EXPECT_EQ(gate.forces().at(1), kForce);
  gate.let_through(kEveryLater);
}

/// Of two forces during one exchange only the newer leaves, but the wait counts from the older: so long the device made
/// a force that was no longer asked for. A force that is set again unchanged is no new force.
TEST(BridgeExchange, TheWaitCountsFromTheFirstForceThatTheDeviceDoesNotHave) {
  Gate gate;
  Exchange exchange(std::make_unique<GatedDevice>(gate, true), milliseconds(1), seconds(60));
  gate.wait_for_exchange(1);
  const Nanoseconds first = now_monotonic() - milliseconds(50);
  exchange.set_force(kForce, first);
  exchange.set_force(kOther, now_monotonic());
  gate.let_through(2);
  gate.wait_for_exchange(3);
  EXPECT_EQ(gate.forces().at(1), kOther);
  EXPECT_EQ(exchange.force_waits().forces, 1);
  EXPECT_GE(exchange.force_waits().worst, milliseconds(50));
  exchange.set_force(kOther, now_monotonic());
  gate.let_through(4);
  gate.wait_for_exchange(5);
  EXPECT_EQ(exchange.force_waits().forces, 1);
  gate.let_through(kEveryLater);
}

TEST(BridgeExchange, AForceThatNobodyRenewsBecomesZero) {
  Gate gate;
  Exchange exchange(std::make_unique<GatedDevice>(gate, true), milliseconds(1), milliseconds(20));
  gate.wait_for_exchange(1);
  exchange.set_force(kForce, now_monotonic() - milliseconds(21));
  gate.let_through(1);
  gate.wait_for_exchange(2);
  EXPECT_EQ(gate.forces().at(1), Vec{});
  gate.let_through(kEveryLater);
}

TEST(BridgeExchange, ADeviceThatDoesNotAnswerHasTakenNoForce) {
  Gate gate;
  gate.let_through(kEveryLater);
  Exchange exchange(std::make_unique<GatedDevice>(gate, false), milliseconds(1), seconds(60));
  exchange.set_force(kForce, now_monotonic());
  gate.wait_for_exchange(5);
  EXPECT_EQ(exchange.force_waits().forces, 0);
  EXPECT_EQ(exchange.longest_exchange(), Nanoseconds(0));
  EXPECT_FALSE(exchange.newest());
  EXPECT_EQ(exchange.problem(), "closed");
}

TEST(BridgeExchange, SendsZeroForceAtItsEnd) {
  Gate gate;
  gate.let_through(kEveryLater);
  {
    Exchange exchange(std::make_unique<GatedDevice>(gate, true), milliseconds(1), seconds(60));
    exchange.set_force(kForce, now_monotonic());
    gate.wait_for_exchange(3);
  }
  EXPECT_EQ(gate.forces().back(), Vec{});
}

}  // namespace
}  // namespace ligature::bridge
