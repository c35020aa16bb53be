// Start-up of both hands: what happens to one hand's drives when the other's are refused.
#include "firmware/app/rig_setup.hpp"

#include <gtest/gtest.h>

#include "tests/unit/platform/fake_bus.hpp"

namespace ligature::app {
namespace {

/// Drives that note what start-up calls.
class NotedDrives final : public platform::HandDrives {
 public:
  using Answer = std::optional<std::string>;
  NotedDrives(std::string& calls, char name) : calls_(calls), name_(name) {}

  Answer other_controller(platform::BusWait&) override { return note("listen", hears); }
  Answer configure(platform::BusWait&) override { return note("configure", refuses); }
  Answer release(platform::BusWait&) override { return note("release", stays_on); }
  [[nodiscard]] std::vector<std::string> lacks() const override { return {}; }
  [[nodiscard]] std::vector<can::Frame> example_samples() const override { return {}; }
  bool start() noexcept override { return true; }
  void request() noexcept override {}
  void drain() noexcept override {}
  [[nodiscard]] bool is_settled() const noexcept override { return true; }
  [[nodiscard]] rt::HandReading reading() const noexcept override { return {}; }
  std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand&) noexcept override { return {}; }
  [[nodiscard]] rt::BusTime bus_time() const noexcept override { return {}; }

  Answer hears, refuses, stays_on;

 private:
  Answer note(const std::string& call, const Answer& answer) {
    calls_ += name_ + (" " + call + "; ");
    return answer;
  }
  std::string& calls_;
  char name_;
};

class BothHands : public ::testing::Test {
 protected:
  BothHands() {
    buses.left = std::make_unique<platform::FakeBus>();
    buses.right = std::make_unique<platform::FakeBus>();
    buses.drives[0] = std::make_unique<NotedDrives>(calls, 'L');
    buses.drives[1] = std::make_unique<NotedDrives>(calls, 'R');
  }
  NotedDrives& drives(std::size_t hand) { return static_cast<NotedDrives&>(*buses.drives[hand]); }
  std::string refusal() {
    const auto why = configure(buses);
    EXPECT_EQ(why ? why->exit_code : 3, 3);
    return why ? why->text : "none";
  }
  std::string calls;
  Buses buses;
};

TEST_F(BothHands, AreSetUpOneAfterTheOther) {
  EXPECT_EQ(refusal(), "none");
  EXPECT_EQ(calls, "L listen; R listen; L configure; R configure; ");
}

/// The drives of the other hand may act from an earlier run: they must be stopped too, or be named.
TEST_F(BothHands, TheOtherHandIsSwitchedOffIfOneIsRefused) {
  drives(0).refuses = "node 1: no answer";
  EXPECT_EQ(refusal(), "left hand: node 1: no answer");
  EXPECT_EQ(calls, "L listen; R listen; L configure; R release; ");
  calls.clear();
  drives(1).stays_on = "node 2 stays on";
  EXPECT_EQ(refusal(), "left hand: node 1: no answer; right hand: node 2 stays on");
  calls.clear();
  drives(0).refuses.reset();
  drives(1).refuses = "no buttons";
  EXPECT_EQ(refusal(), "right hand: no buttons");
  EXPECT_EQ(calls, "L listen; R listen; L configure; R configure; L release; ");
}

/// Whose drives these are is not known: nothing is sent to any of them.
TEST_F(BothHands, NoneIsTouchedIfAnotherControllerIsHeard) {
  for (const std::size_t hand : {1U, 0U}) {
    calls.clear();
    drives(hand).hears = "another controller";
    EXPECT_EQ(refusal(), hand == 0 ? "left hand: another controller" : "right hand: another controller");
    EXPECT_EQ(calls, hand == 0 ? "L listen; " : "L listen; R listen; ");
  }
}

}  // namespace
}  // namespace ligature::app
