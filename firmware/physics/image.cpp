#include "firmware/physics/image.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "protocol/recorder/crc32.hpp"

namespace ligature::physics {
namespace {

constexpr std::string_view kMagic = "LIGIMAGE", kVersion = LIGATURE_VERSION;

struct Header {
  std::array<char, 8> magic{};
  std::array<char, 16> version{};  // of Ligature, padded with zeros
  std::int64_t ticks = 0;
  ImageOrigin origin;
  std::uint32_t contents_crc = 0;
  std::uint32_t header_crc = 0;  // of all bytes before it
};
static_assert(sizeof(Header) == 48 && kVersion.size() < 16);

std::uint32_t crc_of(const Header& header) noexcept {
  return checksum(std::as_bytes(std::span(&header, 1)).first(offsetof(Header, header_crc)));
}

std::string_view text_of(const std::array<char, 16>& padded) noexcept {
  return {padded.data(), static_cast<std::size_t>(std::ranges::find(padded, '\0') - padded.begin())};
}

}  // namespace

std::uint32_t checksum(std::span<const std::byte> bytes) noexcept { return recorder::crc32(bytes); }

ImageBytes with_header(const ImageOrigin& origin, const Image& image) {
  Header header;
  std::ranges::copy(kMagic, header.magic.begin());
  std::ranges::copy(kVersion, header.version.begin());
  header.ticks = image.ticks;
  header.origin = origin;
  header.contents_crc = checksum(image.contents);
  header.header_crc = crc_of(header);
  ImageBytes bytes(sizeof header + image.contents.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  std::ranges::copy(image.contents, bytes.begin() + sizeof header);
  return bytes;
}

std::variant<Image, std::string> read_image(std::span<const std::byte> bytes, const ImageOrigin& allowed) {
  Header header;
  auto damaged = std::string("the image is damaged: save it again");
  if (bytes.size() < sizeof header) return "found " + std::to_string(bytes.size()) + " bytes, allowed a whole image";
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::string_view(header.magic.data(), header.magic.size()) != kMagic)
    return std::string("this is no image of a simulation: allowed what save() has made");
  if (header.header_crc != crc_of(header)) return damaged;
  const std::string found = "the image was saved by ", ligature = std::string(kVersion);
  if (text_of(header.version) != kVersion)
    return found + "Ligature " + std::string(text_of(header.version)) + ", allowed " + ligature + ": save it again";
  if (header.origin.layout != allowed.layout)
    return found + "another build of Ligature " + ligature + ", whose simulation has other members: save it again";
  if (header.origin.scene != allowed.scene)
    return found + "a simulation of another scene: load it with the scene and the overrides of that simulation";
  const Image image{header.ticks, bytes.subspan(sizeof header)};
  if (header.contents_crc != checksum(image.contents)) return damaged;
  return image;
}

}  // namespace ligature::physics
