#pragma once
// Ties one knot with an operator that sees the thread and moves two simulated devices: through encoder counts, CAN
// frames and coupling. The result is read from the recording.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/lab/tie/hand_record.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

struct Tied {
  /// type and handedness of the knot as host/knot names them ("3_1 right"): the wanted knot, and the one found in the
  /// recording's last shape
  std::string wanted, found;
  double seconds = 0.0;             ///< on the rig's clock, including the time in which the knot is watched
  std::vector<std::string> missed;  ///< moves of the operator that exceeded their time limit
  [[nodiscard]] bool good() const { return wanted == found; }
};

/// The rig has one period, in which the thread makes one tick. @throws Refusal when the scene's tick is another one.
void check_tick(const scene::Scene& scene, const std::string& scene_file);

/// @param scene_toml as made by scene::recorded_text(); the operator's knot and seed are added.
/// @param recording path of the LCM log; an existing file is replaced when the new one is whole.  @param hands records
/// the hands' motion.
/// @throws Refusal for an unknown knot or a scene in which the operator cannot work; validate::Interrupted;
/// std::runtime_error when the rig does not start or the file cannot be created.
[[nodiscard]] Tied tie_once(const scene::Scene& scene, const std::string& scene_file, const std::string& scene_toml,
                            const std::string& knot, std::uint32_t seed, const std::filesystem::path& recording,
                            HandRecord* hands = nullptr);

}  // namespace ligature::lab
