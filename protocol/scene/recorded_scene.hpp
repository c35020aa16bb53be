#pragma once
// How a recording carries a scene: its file's text, and behind it, as comments, what else made it what it was.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// The text of a recording, which is a scene file still, and lines may be added to it:
///   ... the file, as it was read
///   # as run:
///   # shape 0123abcd            CRC-32 of the initial shape, where the scene takes it from a file of its own
///   # --set suture.nodes=35     each override, in order
///   # --force: why              it is not admitted
///   # seed 7                    of a simulated operator
[[nodiscard]] std::string recorded_text(std::string text, std::span<const std::string> overrides, const Scene& scene);

/// One more override, after the others.
void add_override(std::string& recorded, std::string_view override);

struct RecordedScene {
  std::string text;
  std::vector<std::string> overrides;
  std::optional<std::uint32_t> shape;
};
[[nodiscard]] RecordedScene split_recorded(const std::string& recorded);

/// The scene again, with other overrides on top: one that names a key of a recorded override comes in its place.
/// @param path of the scene's file, for its messages and for the shape that it names.
/// @return the scene, or one line that says what is missing or wrong, a shape that is another one now included.
[[nodiscard]] std::variant<Scene, Error> parse_recorded(const std::string& recorded, const std::string& path,
                                                        std::span<const std::string> overrides = {});

/// The key of a `key=value`, without blanks.
[[nodiscard]] std::string_view key_of(std::string_view override);

}  // namespace ligature::scene
