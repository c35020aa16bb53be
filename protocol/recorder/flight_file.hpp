#pragma once
// Layout of a flight recorder file: a header, then a ring of slots with one tick each. Little-endian.
//
//   0       Header, kHeaderBytes, with its own CRC
//   + i S   slot i of S = slot_bytes: SlotHead, then `bytes` of payload: a tick_t in LCM encoding, without its hash
//   + j K   from version 3 on, scene j of K = kSceneBytes: a SceneEntry per change of scene or parameter; their number
//           follows from the file's size
//
// Record number q (from 1) is in slot (q - 1) mod slots. The CRC of a slot covers number, length and payload, so it
// reveals a slot that was being written when the machine stopped, or that the disk lost. If the writer dies, at most
// one slot is incomplete. Scene entry number e (from 1) is at place (e - 1) mod their count, protected in the same way.
// The header's scene is valid from the first tick on, an entry's from its first_tick. The file has no
// index that a crash could damage.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "protocol/recorder/crc32.hpp"

namespace ligature::recorder {

inline constexpr std::array<char, 8> kMagic{'L', 'G', 'F', 'L', 'I', 'G', 'H', 'T'};
inline constexpr std::uint32_t kVersion = 3, kOldestVersion = 2;
inline constexpr std::size_t kHeaderBytes = 65536;
inline constexpr std::int64_t kMaxSlots = 4'000'000;
inline constexpr std::uint32_t kMaxSlotBytes = 4096;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t slot_bytes = 0;
  std::int64_t slots = 0;
  std::int64_t tick_hash = 0;  ///< LCM's hash of tick_t; differs if the message type was changed
  std::int64_t session = 0;    ///< id of the firmware's run: CLOCK_REALTIME at its start, microseconds
  double period_s = 0.0;
  double max_force_N = 0.0;
  std::int32_t fault = 0;  ///< number of the fault because of which the file was saved; else 0
  std::uint32_t toml_bytes = 0;
  std::array<char, 32> firmware_version{};
  std::array<char, 256> scene_file{};
  std::array<char, 61440> scene_toml{};  ///< the scene's text; truncated if longer
  std::uint32_t crc = 0;                 ///< CRC-32 of all bytes before it
};
static_assert(std::is_trivially_copyable_v<Header> && sizeof(Header) <= kHeaderBytes);

/// A scene that was put in force while the rig ran.
struct SceneEntry {
  std::uint64_t number = 0;  ///< 0: never written
  std::int64_t first_tick = 0;
  double max_force_N = 0.0;
  std::int32_t admitted = 0;  ///< 0: not admitted, run because of --force
  std::uint32_t toml_bytes = 0;
  std::array<char, 256> scene_file{};
  std::array<char, 61440> scene_toml{};  ///< the scene's text with its overrides; truncated if longer
  std::uint32_t crc = 0;                 ///< CRC-32 of all bytes before it
};
inline constexpr std::size_t kSceneBytes = 65536;
inline constexpr std::size_t kMostScenes = 64;
static_assert(std::is_trivially_copyable_v<SceneEntry> && sizeof(SceneEntry) <= kSceneBytes);

struct SlotHead {
  std::uint64_t sequence = 0;  ///< 0: never written
  std::uint32_t bytes = 0;
  std::uint32_t crc = 0;
};
static_assert(sizeof(SlotHead) == 16);

[[nodiscard]] inline std::uint32_t crc_of(const Header& header) noexcept {
  return crc32(std::as_bytes(std::span(&header, 1)).first(offsetof(Header, crc)));
}

[[nodiscard]] inline std::uint32_t crc_of(const SceneEntry& entry) noexcept {
  return crc32(std::as_bytes(std::span(&entry, 1)).first(offsetof(SceneEntry, crc)));
}

[[nodiscard]] inline std::uint32_t crc_of(const SlotHead& head, std::span<const std::byte> payload) noexcept {
  return crc32(payload, crc32(std::as_bytes(std::span(&head, 1)).first(offsetof(SlotHead, crc))));
}

[[nodiscard]] constexpr std::size_t slot_of(std::uint64_t sequence, std::int64_t slots) noexcept {
  return static_cast<std::size_t>((sequence - 1) % static_cast<std::uint64_t>(slots));
}

/// Slot size for a payload, rounded up to whole cache lines.
[[nodiscard]] constexpr std::uint32_t slot_bytes_for(std::size_t payload) noexcept {
  return static_cast<std::uint32_t>((sizeof(SlotHead) + payload + 63) / 64 * 64);
}

/// Copies as much as fits, zero-terminated.
template <std::size_t N>
void put_text(std::array<char, N>& to, std::string_view text) noexcept {
  to = {};
  std::memcpy(to.data(), text.data(), text.size() < N ? text.size() : N - 1);
}

}  // namespace ligature::recorder
