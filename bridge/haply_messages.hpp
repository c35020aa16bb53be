#pragma once
// The JSON messages of Haply's Inverse Service, version 3 (https://docs.haply.co/inverseSDK/service): the service sends
// one state for each message that it gets, and one unasked when a client connects.

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

  /// Facts of the status of device and grip that were false when the service last sent them.
  std::set<std::string> missing = {}, grip_missing = {};
  std::set<std::string> grips = {};  ///< ids of all grips that were in a message
};

/// What a message of the service says of the device. Later messages contain only what is new, so `before` is kept up to
/// date: pass the same object for each message of a connection. @return nothing when the message is no valid JSON or
/// does not contain the device.
[[nodiscard]] std::optional<HaplyState> read_haply(std::string_view text, const HaplyChoice& choice,
                                                   HaplyState& before);

/// A message with a command to the service. @param is_first  true: it also tells the service the name of this program,
/// as the first message must.
[[nodiscard]] std::string haply_command(const std::string& inverse3_id, const Vec& force_D_N, bool is_first);

}  // namespace ligature::bridge
