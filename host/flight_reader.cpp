#include "host/flight_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "host/errors.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

template <std::size_t N>
std::string text_in(const std::array<char, N>& field) {
  return {field.data(), strnlen(field.data(), N)};
}

/// @return whether the file is long enough for a header and could be read.
bool read_header(const RegularFile& file, recorder::Header& header) {
  return file.size() >= static_cast<std::int64_t>(recorder::kHeaderBytes) &&
         file.read_at(static_cast<void*>(&header), sizeof header, 0) == sizeof header;
}

}  // namespace

bool is_flight_file(const std::string& path) try {
  const RegularFile file(path);
  std::array<char, 8> magic{};
  return file.read_at(magic.data(), magic.size(), 0) == magic.size() && magic == recorder::kMagic;
} catch (const BadInput&) {
  return false;
}

std::optional<std::int64_t> session_of(const RegularFile& file) {
  const auto header = std::make_unique<recorder::Header>();
  if (!read_header(file, *header) || header->magic != recorder::kMagic || header->crc != recorder::crc_of(*header))
    return std::nullopt;
  return header->session;
}

FlightReader::FlightReader(const std::string& path) : FlightReader(RegularFile(path), path) {}

FlightReader::FlightReader(const RegularFile& file, const std::string& path) {
  if (!read_header(file, header_)) throw BadInput(path + ": shorter than a flight recorder's header");
  check(path, file.size());
  ring_.resize(static_cast<std::size_t>(file.size()) - recorder::kHeaderBytes);
  if (file.read_at(ring_.data(), ring_.size(), recorder::kHeaderBytes) != ring_.size())
    throw BadInput(path + ": became shorter while it was read");
  index();
  read_scenes(std::span(ring_).subspan(static_cast<std::size_t>(header_.slots) * header_.slot_bytes));
}

void FlightReader::check(const std::string& path, std::int64_t size) const {
  const auto& h = header_;
  if (h.magic != recorder::kMagic) throw BadInput(path + ": not a flight recorder file");
  if (h.version < recorder::kOldestVersion || h.version > recorder::kVersion)
    throw BadInput(path + text(": found flight recorder version %u, allowed %u .. %u", h.version,
                               recorder::kOldestVersion, recorder::kVersion));
  if (h.crc != recorder::crc_of(h)) throw BadInput(path + ": the header's CRC is wrong: the file was damaged");
  if (h.tick_hash != ligature_msg::tick_t::getHash())
    throw BadInput(path + ": written with another tick_t, by ligature-firmware " + text_in(h.firmware_version));
  const bool sane = h.slots >= 1 && h.slots <= recorder::kMaxSlots && h.slot_bytes > sizeof(recorder::SlotHead) &&
                    h.slot_bytes <= recorder::kMaxSlotBytes && std::isfinite(h.period_s) && h.period_s > 0.0;
  if (!sane) throw BadInput(path + ": the header makes no sense");
  const std::int64_t wanted = static_cast<std::int64_t>(recorder::kHeaderBytes) + h.slots * h.slot_bytes;
  const std::int64_t scenes_bytes = size - wanted, one = recorder::kSceneBytes;
  const std::int64_t most = h.version < 3 ? 0 : one * static_cast<std::int64_t>(recorder::kMostScenes);
  if (scenes_bytes < 0 || scenes_bytes > most || scenes_bytes % one != 0)
    throw BadInput(path + text(": found %lld bytes, the header says %lld", static_cast<long long>(size),
                               static_cast<long long>(wanted)));
}

std::span<const std::byte> FlightReader::slot(std::size_t i) const {
  return std::span(ring_).subspan(i * header_.slot_bytes, header_.slot_bytes);
}

void FlightReader::index() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(header_.slots); ++i) {
    recorder::SlotHead head;
    std::memcpy(&head, slot(i).data(), sizeof head);
    if (head.sequence == 0 && head.bytes == 0 && head.crc == 0) continue;  // never written
    const auto payload = slot(i).subspan(sizeof head);
    const bool sound = head.sequence != 0 && head.bytes <= payload.size() &&
                       recorder::slot_of(head.sequence, header_.slots) == i &&
                       head.crc == recorder::crc_of(head, payload.first(head.bytes));
    if (sound)
      sound_.push_back({head.sequence, i});
    else
      ++damaged_;
  }
  std::ranges::sort(sound_, {}, &Entry::sequence);
}

void FlightReader::visit(const std::function<void(const ligature_msg::tick_t&)>& take) const {
  for (const Entry& entry : sound_) {
    recorder::SlotHead head;
    std::memcpy(&head, slot(entry.slot).data(), sizeof head);
    const auto payload = slot(entry.slot).subspan(sizeof head, head.bytes);
    ligature_msg::tick_t tick;
    const int size = static_cast<int>(payload.size());
    if (tick._decodeNoHash(payload.data(), 0, size) == size && tick.tick >= 0) take(tick);
  }
}

/// Reads the entries for changes of scene. Skips entries with a wrong CRC: they were never written, or the writer died
/// while writing them.
void FlightReader::read_scenes(std::span<const std::byte> entries) {
  const auto facts = [&](const auto& from) {
    return RigFacts{header_.period_s,         from.max_force_N,         true,
                    text_in(from.scene_file), text_in(from.scene_toml), text_in(header_.firmware_version)};
  };
  const auto begun = facts(header_);
  scenes_.push_back({0, begun, begun.scene_toml.find("\n# --force: ") == std::string::npos});
  const auto entry = std::make_unique<recorder::SceneEntry>();
  for (; entries.size() >= recorder::kSceneBytes; entries = entries.subspan(recorder::kSceneBytes)) {
    std::memcpy(static_cast<void*>(entry.get()), entries.data(), sizeof *entry);
    if (entry->number == 0 || entry->crc != recorder::crc_of(*entry)) continue;
    scenes_.push_back({entry->first_tick, facts(*entry), entry->admitted != 0});
  }
  std::stable_sort(scenes_.begin() + 1, scenes_.end(),
                   [](const Scene& a, const Scene& b) { return a.first_tick < b.first_tick; });
}

const FlightReader::Scene& FlightReader::scene_at(std::int64_t tick) const {
  const auto later =
      std::find_if(scenes_.begin() + 1, scenes_.end(), [&](const Scene& s) { return s.first_tick > tick; });
  return *(later - 1);
}

std::int64_t FlightReader::oldest_tick() const {
  ligature_msg::tick_t tick{};
  if (sound_.empty()) return 0;
  const auto payload = slot(sound_.front().slot).subspan(sizeof(recorder::SlotHead));
  tick._decodeNoHash(payload.data(), 0, static_cast<int>(payload.size()));
  return tick.tick;
}

RigFacts FlightReader::facts() const { return scene_at(oldest_tick()).facts; }

}  // namespace ligature::host
