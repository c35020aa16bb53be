#pragma once
// A script played through the whole chain on a simulated clock by hands that are not quite the script's, on a rig that
// is not quite in time.

#include <cstdint>
#include <filesystem>
#include <string>

#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// What a live run has and a script does not know. A seed decides the rest.
struct Trouble {
  double tremor_mm = 0.1;     ///< of each hand at the device, on each axis, 8 to 12 Hz
  double late_ms = 20.0;      ///< one of the hands begins up to so much after the other
  double lost_share = 0.002;  ///< of the periods, in stalls of 1 .. 10
  double frame_loss = 0.0;    ///< of the process data frames
  double work_share = 1.0;    ///< of the thread's budget of work in a tick that this machine affords
};

struct Played {
  std::string found;           ///< type and handedness of the thread's last shape
  double seconds = 0.0;        ///< of the rig's clock
  double stood_still_s = 0.0;  ///< the thread, its work spent
  std::int64_t periods_lost = 0;
  int fault = 0;  ///< the last one; 0: none
};

/// @param recording where the log goes; empty: nowhere.  @throws Refusal, std::runtime_error
[[nodiscard]] Played play_once(const scene::Scene& scene, const std::string& scene_file, const std::string& scene_toml,
                               const scene::GripperScript& script, const Trouble& trouble, std::uint32_t seed,
                               const std::filesystem::path& recording);

}  // namespace ligature::lab
