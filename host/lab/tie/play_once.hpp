#pragma once
// Plays a script through the whole chain on a simulated clock, with disturbed hand motion and a disturbed rig.

#include <cstdint>
#include <filesystem>
#include <string>

#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// Disturbances of a live run. Random details depend on the seed only.
struct Trouble {
  double tremor_mm = 0.1;     ///< amplitude of each hand's tremor at the device, per axis, 8 to 12 Hz
  double late_ms = 20.0;      ///< largest random delay of one hand behind the other
  double lost_share = 0.002;  ///< fraction of the control periods that the loop loses, in stalls of 1 .. 10 periods
  double frame_loss = 0.0;    ///< fraction of the process data frames (PDOs) that are lost
  double work_share = 1.0;    ///< fraction of the contact budget per tick that the thread's physics may use
};

struct Played {
  std::string found;           ///< type and handedness of the knot in the thread's last shape
  double seconds = 0.0;        ///< duration on the rig's clock
  double stood_still_s = 0.0;  ///< time lost: the thread was not moved because its budget was used up
  std::int64_t periods_lost = 0;
  int fault = 0;  ///< fault number of the last fault; 0: none
};

/// @param recording name of the log; empty: none.  @throws Refusal, std::runtime_error, validate::Interrupted
[[nodiscard]] Played play_once(const scene::Scene& scene, const std::string& scene_file, const std::string& scene_toml,
                               const scene::GripperScript& script, const Trouble& trouble, std::uint32_t seed,
                               const std::filesystem::path& recording);

}  // namespace ligature::lab
