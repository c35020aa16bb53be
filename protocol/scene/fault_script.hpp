#pragma once
// A fault to inject into one hand, and the reaction expected of the rig. Files: scenes/faults/*.toml.

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

enum class FaultKind : std::uint8_t {
  kLose,       ///< frames of the drives are lost
  kDelay,      ///< frames of the drives arrive delay_s later
  kDuplicate,  ///< frames of the drives arrive twice
  kReorder,    ///< each frame arrives after the next one
  kCorrupt,    ///< a data bit is wrong although the CAN CRC is right
  kFreeze,     ///< the encoder of `node` stands still
  kJump,       ///< the encoder of `node` is off by `counts`
  kReverse,    ///< the encoder of `node` counts backwards from its present value
  kButton,     ///< the stylus buttons keep their last values
  kReboot,     ///< the drive `node` reboots, once
  kEmergency,  ///< the drive `node` sends an EMCY, once
  kAstray,     ///< the drive `node` makes `permille` more torque than commanded
  kForeign,    ///< another node on the bus sends `frame` to `node` every period_s
};

/// Frames of another controller.
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
  double share = 1.0;   ///< fraction of the frames that is affected, 0 .. 1
  double from_s = 0.0;  ///< start of the fault, s after the first SYNC
  double until_s = 1e9;
  double delay_s = 0.0;
  int counts = 0;
  int seed = 1;      ///< selects the affected frames if share < 1
  int permille = 0;  ///< torque, per mille of the rated torque
  ForeignFrame frame = ForeignFrame::kRpdo;
  double period_s = 1e-3;

  int expected_fault = 0;  ///< fault number (docs/architecture.md); 0: the rig continues
  int within_ticks = 0;    ///< ticks after the start of the fault within which both hands' torques must become zero
};

/// @return the script, or one line that says what is wrong with the file. As strict as scene files.
[[nodiscard]] std::variant<FaultScript, Error> load_fault_script(const std::filesystem::path& path);

}  // namespace ligature::scene
