#pragma once
// The image of a simulation: its saved state as bytes (member_bytes.hpp), after a header that tells to which build and
// scene the image belongs.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ligature::physics {

using ImageBytes = std::vector<std::byte>;

/// What an image belongs to. Checksums are CRC-32.
struct ImageOrigin {
  std::uint32_t layout = 0;  ///< checksum of the names of all members' types: differs in a build with other members
  std::uint32_t scene = 0;   ///< checksum of the contents of a simulation that was just made from the scene
  bool operator==(const ImageOrigin&) const = default;
};

[[nodiscard]] std::uint32_t checksum(std::span<const std::byte> bytes) noexcept;

struct Image {
  std::int64_t ticks = 0;  ///< of the simulation, as its owner counts them
  std::span<const std::byte> contents;
};

/// Puts the header before the contents.
[[nodiscard]] ImageBytes with_header(const ImageOrigin& origin, const Image& image);

/// @return what is in an image, or one line that says why it cannot be loaded
[[nodiscard]] std::variant<Image, std::string> read_image(std::span<const std::byte> bytes, const ImageOrigin& allowed);

}  // namespace ligature::physics
