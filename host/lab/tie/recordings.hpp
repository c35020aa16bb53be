#pragma once
// File names of the recordings of several runs: DIR/KNOT-SEED.lcmlog.

#include <cstdint>
#include <filesystem>
#include <string>

#include "host/lab/outcome.hpp"
#include "host/lab/tie/seeds.hpp"

namespace ligature::lab {

[[nodiscard]] inline std::filesystem::path recording_of(const std::filesystem::path& folder, const std::string& knot,
                                                        std::uint32_t seed) {
  return folder / (knot + "-" + std::to_string(seed) + ".lcmlog");
}

/// Checks that no recording exists yet. Called before the first run, so that no finished run is lost by a refusal.
/// @throws Refusal with the name of the first recording that exists, unless `replace` is true.
inline void check_free(const std::filesystem::path& folder, const std::string& knot, const Seeds& seeds, bool replace) {
  if (replace) return;
  for (std::uint32_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const auto path = recording_of(folder, knot, seed);
    if (std::filesystem::exists(std::filesystem::symlink_status(path)))
      throw Refusal(path.string() + ": exists; allowed: another --out, or --force to replace it");
  }
}

}  // namespace ligature::lab
