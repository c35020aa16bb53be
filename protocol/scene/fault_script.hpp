#pragma once
// A fault that shall happen to one hand, and what the rig has to make of it. Files: scenes/faults/*.toml.

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

enum class FaultKind : std::uint8_t {
  kLose,       ///< frames of the drives do not arrive
  kDelay,      ///< they arrive delay_s later
  kDuplicate,  ///< they arrive twice
  kReorder,    ///< they arrive after the next one
  kCorrupt,    ///< a bit of their data is wrong, beyond what a CAN controller's own CRC lets through
  kFreeze,     ///< the encoder of `node` stands still
  kJump,       ///< it is off by `counts`
  kReverse,    ///< it counts backwards from where it was
  kButton,     ///< the stylus buttons stay as they were
  kReboot,     ///< the drive `node` starts anew, once
  kEmergency,  ///< the drive `node` sends an emergency, once
  kAstray,     ///< the drive `node` makes `permille` more torque than it is asked for
  kForeign,    ///< somebody else on the bus sends `frame` to `node` every period_s
};

/// What somebody who is not the controller may send.
enum class ForeignFrame : std::uint8_t {
  kRpdo,
  kSync,
  kHeartbeat,
  kNmtStart,
  kNmtStop,
  kNmtReset,
  kSdoRead,
  kSdoWrite
};

struct FaultScript {
  std::string title;  ///< one line for people
  FaultKind kind = FaultKind::kLose;
  int hand = 0;         ///< 0 left, 1 right
  int node = 0;         ///< 1 .. 3; 0 = all of the hand's drives
  double share = 1.0;   ///< of the frames, 0 .. 1
  double from_s = 0.0;  ///< since the first SYNC
  double until_s = 1e9;
  double delay_s = 0.0;
  int counts = 0;
  int seed = 1;      ///< which frames, when share < 1
  int permille = 0;  ///< torque, of the rated one
  ForeignFrame frame = ForeignFrame::kRpdo;
  double period_s = 1e-3;

  int expected_fault = 0;  ///< number of docs/architecture.md; 0: the rig carries on
  int within_ticks = 0;    ///< from the onset until no torque is commanded to either hand
};

/// @return the script, or the one line that says what is wrong with the file. Strict, as scenes are.
[[nodiscard]] std::variant<FaultScript, Error> load_fault_script(const std::filesystem::path& path);

}  // namespace ligature::scene
