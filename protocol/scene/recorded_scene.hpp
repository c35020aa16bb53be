#pragma once
// How recordings store a scene: the text of its file, followed by comments with everything else that determined the
// run.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// The text stored in a recording. It is itself a valid scene file; further lines may be appended:
///   ... the file as read
///   # as run:
///   # shape 0123abcd            CRC-32 of the start shape, if the scene reads it from a separate file
///   # --set suture.nodes=35     each override, in order
///   # --force: why              reason why it was not admitted
///   # seed 7                    seed of a simulated operator
///   # samples 380000            ns from SYNC until the bus can have carried the joint samples, at the earliest
[[nodiscard]] std::string recorded_text(std::string text, std::span<const std::string> overrides, const Scene& scene);

/// Appends one more override.
void add_override(std::string& recorded, std::string_view override);

/// Appends the earliest time at which the bus can have carried the joint samples, ns after SYNC.
void add_earliest_samples(std::string& recorded, std::int64_t after_ns);

struct RecordedScene {
  std::string text;
  std::vector<std::string> overrides;
  std::optional<std::uint32_t> shape;
  std::int64_t samples_earliest_ns = 0;  ///< 0: not recorded
};
[[nodiscard]] RecordedScene split_recorded(const std::string& recorded);

/// Parses a recorded scene, with further overrides: one with the key of a recorded override replaces that one.
/// @param path of the scene's file, for messages and for finding its shape file
/// @return the scene, or one line that says what is missing or wrong, for example if the shape file has changed
[[nodiscard]] std::variant<Scene, Error> parse_recorded(const std::string& recorded, const std::string& path,
                                                        std::span<const std::string> overrides = {});

/// The key of `key=value`, without blanks.
[[nodiscard]] std::string_view key_of(std::string_view override);

}  // namespace ligature::scene
