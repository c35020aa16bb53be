#pragma once
// The JSON messages of Haply's Inverse Service, 3.5 or newer (https://docs.haply.co/inverseSDK/service): the service
// answers each message with one state, and sends one state unasked when a client connects.

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "bridge/device.hpp"

namespace ligature::bridge {

/// Selects a device of the service, and the buttons of its grip. An empty id selects the first device, or the only
/// grip.
struct HaplyChoice {
  std::string inverse3_id;
  std::string grip_id;
  std::string dead_man = "a", grip = "b", clutch = "c";  ///< keys in the grip's "buttons"
};

struct HaplyState {
  std::string inverse3_id;
  DeviceState state;
  std::string problem;  ///< why the device must not be used now, such as "not calibrated"; empty: it may

  /// Status facts of the device and of its grip (such as "calibrated") that the service last reported as false.
  std::set<std::string> missing = {}, grip_missing = {};
  std::set<std::string> grips = {};  ///< ids of all grips that were in a message
};

/// The device's state after a message of the service. `before` keeps what a later message leaves out: pass the same
/// object for each message of a connection. @return nothing when the message is no valid JSON or does not contain the
/// device.
[[nodiscard]] std::optional<HaplyState> read_haply(std::string_view text, const HaplyChoice& choice,
                                                   HaplyState& before);

/// The message that commands a force. @param is_first true: the message also tells the service the name of this
/// program, as the first one of a connection must.
[[nodiscard]] std::string haply_command(const std::string& inverse3_id, const Vec& force_D_N, bool is_first);

}  // namespace ligature::bridge
