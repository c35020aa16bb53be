#pragma once
// The drives of one hand, whatever their protocol. docs/drives.md explains how to add one.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/platform/bus_wait.hpp"
#include "firmware/platform/can_bus.hpp"
#include "firmware/rt/bus_time.hpp"
#include "firmware/rt/rig_io.hpp"
#include "protocol/can/frame.hpp"

namespace ligature::platform {

class HandDrives {
 public:
  HandDrives() = default;
  virtual ~HandDrives() = default;
  HandDrives(const HandDrives&) = delete;
  HandDrives& operator=(const HandDrives&) = delete;

  // The next functions are called before the loop; they may wait and allocate memory.
  /// Listens whether another controller uses the bus. Sends nothing. @return what was heard, in one line, or nothing.
  [[nodiscard]] virtual std::optional<std::string> other_controller(BusWait& wait) = 0;
  /// Sets the drives up and checks that they are the drives of the device record. They make no torque afterwards.
  /// @return why not, in one line, or nothing.
  [[nodiscard]] virtual std::optional<std::string> configure(BusWait& wait) = 0;
  /// Which guarantees these drives cannot give, because they lack a function; one line each. Complete after
  /// configure().
  [[nodiscard]] virtual std::vector<std::string> lacks() const = 0;
  /// Example of the frames that the drives send in one period. Admission measures with it how long reading these frames
  /// takes.
  [[nodiscard]] virtual std::vector<can::Frame> example_samples() const = 0;
  /// Lets the drives take part in the cyclic exchange. They stay switched off until write() requests kEnable.
  virtual bool start() noexcept = 0;

  // The next functions are called in each period, in this order. Real time: bounded, no allocation, no lock, only the
  // bus's system calls.
  /// Reads late samples of the last period, then asks all drives for a sample.
  virtual void request() noexcept = 0;
  /// Reads all frames that have arrived.
  virtual void drain() noexcept = 0;
  /// Whether waiting for samples is over: all are there, or the bus is lost.
  [[nodiscard]] virtual bool is_settled() const noexcept = 0;
  /// The newest complete set of samples, with its age in periods; control/sample_age.hpp decides what the age means.
  [[nodiscard]] virtual rt::HandReading reading() const noexcept = 0;
  /// Sends state request and torques. @return the torques as sent, per mille of the rated one; zero if the bus is lost
  virtual std::array<std::int16_t, rt::kJoints> write(const rt::HandCommand& command) noexcept = 0;
  [[nodiscard]] virtual rt::BusTime bus_time() const noexcept = 0;

  /// After the loop: switches the drives off, and makes sure that they do not report the controller's following silence
  /// as a fault. May wait. @return which drives do not say that they are off, in one line, or nothing
  virtual std::optional<std::string> release(BusWait& wait) = 0;
};

}  // namespace ligature::platform
