#pragma once
// One knot, tied by an operator who sees the thread and moves two simulated devices: counts, frames, coupling, and the
// recording that the knot is read back from.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/lab/tie/hand_record.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

struct Tied {
  std::string wanted, found;  ///< type and handedness by host/knot ("3_1 right"); found: in the recording's last shape
  double seconds = 0.0;       ///< of the rig's clock, watching the knot included
  std::vector<std::string> missed;  ///< moves that ran out of patience
  std::filesystem::path recording;
  [[nodiscard]] bool good() const { return wanted == found; }
};

/// @param scene_toml as scene::recorded_text() makes it; the operator's knot and seed are added.
/// @param folder where KNOT-SEED.lcmlog goes; one of that name is replaced.  @param hands gets what they wanted.
/// @throws Refusal for an unknown knot or a scene that the operator cannot work in; std::runtime_error when the rig
/// does not start or the file cannot be made.
[[nodiscard]] Tied tie_once(const scene::Scene& scene, const std::string& scene_file, const std::string& scene_toml,
                            const std::string& knot, std::uint32_t seed, const std::filesystem::path& folder,
                            HandRecord* hands = nullptr);

}  // namespace ligature::lab
