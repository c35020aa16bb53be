#include "firmware/telemetry/flight_slots.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "firmware/telemetry/messages.hpp"

namespace ligature::telemetry {
namespace {

constexpr std::size_t kAtOnce = 64;  // slots per write: 32 kB

/// Encodes a record as a complete slot: head, payload, zero padding.
void encode(const rt::TickRecord& record, std::uint64_t sequence, std::span<std::byte> slot) {
  const auto payload = slot.subspan(sizeof(recorder::SlotHead));
  const int n = to_message(record)._encodeNoHash(payload.data(), 0, static_cast<int>(payload.size()));
  const auto bytes = static_cast<std::size_t>(n);  // always fits: the slot size comes from slot_bytes_for()
  std::ranges::fill(payload.subspan(bytes), std::byte{0});
  recorder::SlotHead head{sequence, static_cast<std::uint32_t>(bytes), 0};
  head.crc = recorder::crc_of(head, payload.first(bytes));
  std::memcpy(slot.data(), &head, sizeof head);
}

/// Tick of slot 0: the first field of a tick_t, big-endian.
std::int64_t first_tick_in(std::span<const std::byte> image) {
  std::uint64_t tick = 0;
  for (const auto byte : image.subspan(recorder::kHeaderBytes + sizeof(recorder::SlotHead), 8))
    tick = tick << 8U | std::to_integer<std::uint64_t>(byte);
  return static_cast<std::int64_t>(tick);
}

}  // namespace

recorder::Header header_of(const FlightFacts& facts, std::int64_t slots) {
  recorder::Header h;
  std::memset(static_cast<void*>(&h), 0, sizeof h);  // padding between members is part of the CRC
  h.magic = recorder::kMagic;
  h.version = recorder::kVersion;
  h.slot_bytes = recorder::slot_bytes_for(static_cast<std::size_t>(ligature_msg::tick_t{}._getEncodedSizeNoHash()));
  h.slots = slots;
  h.tick_hash = ligature_msg::tick_t::getHash();
  h.session = facts.session;
  h.period_s = facts.period_s;
  h.max_force_N = facts.max_force_N;
  h.toml_bytes = static_cast<std::uint32_t>(std::min(facts.scene_toml.size(), h.scene_toml.size() - 1));
  recorder::put_text(h.firmware_version, facts.firmware_version);
  recorder::put_text(h.scene_file, facts.scene_file);
  recorder::put_text(h.scene_toml, facts.scene_toml);
  h.crc = recorder::crc_of(h);
  return h;
}

std::size_t file_bytes(const recorder::Header& header, std::size_t scenes) {
  return recorder::kHeaderBytes + static_cast<std::size_t>(header.slots) * header.slot_bytes +
         scenes * recorder::kSceneBytes;
}

FlightSlots::FlightSlots(std::string path, Disk& disk, const recorder::Header& header)
    : path_(std::move(path)), disk_(disk), header_(header), scratch_(kAtOnce * header.slot_bytes) {
  disk_.write(std::as_bytes(std::span(&header_, 1)), 0);
}

std::size_t FlightSlots::place_of(std::uint64_t sequence) const noexcept {
  return recorder::kHeaderBytes + recorder::slot_of(sequence, header_.slots) * header_.slot_bytes;
}

std::size_t FlightSlots::append(std::span<const rt::TickRecord> records) {
  std::size_t refused = 0;
  while (!records.empty()) {
    const std::size_t first = recorder::slot_of(sequence_ + 1, header_.slots);
    const std::size_t to_the_end = static_cast<std::size_t>(header_.slots) - first;
    const std::size_t n = std::min({records.size(), kAtOnce, to_the_end});
    for (std::size_t i = 0; i < n; ++i) {
      encode(records[i], sequence_ + 1 + i, std::span(scratch_).subspan(i * header_.slot_bytes, header_.slot_bytes));
    }
    if (disk_.write(std::span(scratch_).first(n * header_.slot_bytes), place_of(sequence_ + 1)))
      sequence_ += n;
    else
      refused += n;
    records = records.subspan(n);
  }
  return refused;
}

void FlightSlots::add(const FlightScene& scene) {
  recorder::SceneEntry& e = scenes_.emplace_back();
  std::memset(static_cast<void*>(&e), 0, sizeof e);  // padding between members is part of the CRC
  e.number = ++scene_number_;
  e.first_tick = scene.first_tick;
  e.max_force_N = scene.max_force_N;
  e.admitted = scene.admitted ? 1 : 0;
  e.toml_bytes = static_cast<std::uint32_t>(std::min(scene.scene_toml.size(), e.scene_toml.size() - 1));
  recorder::put_text(e.scene_file, scene.scene_file);
  recorder::put_text(e.scene_toml, scene.scene_toml);
  e.crc = recorder::crc_of(e);
  disk_.write(std::as_bytes(std::span(&e, 1)), file_bytes(header_, (e.number - 1) % recorder::kMostScenes));
  if (scenes_.size() > recorder::kMostScenes) scenes_.pop_front();
}

/// The scenes in force at that tick or later.
std::vector<const recorder::SceneEntry*> FlightSlots::scenes_from(std::int64_t tick) const {
  std::vector<const recorder::SceneEntry*> wanted;
  for (std::size_t i = 0; i < scenes_.size(); ++i)
    if (i + 1 == scenes_.size() || scenes_[i + 1].first_tick > tick) wanted.push_back(&scenes_[i]);
  return wanted;
}

/// A complete file with the last `count` records, renumbered from 1, so that it has no unused slots.
std::vector<std::byte> FlightSlots::image_of_last(std::uint64_t count, std::int32_t fault) {
  recorder::Header header = header_;
  header.slots = static_cast<std::int64_t>(count);
  header.fault = fault;
  header.crc = recorder::crc_of(header);
  std::vector<std::byte> image(file_bytes(header, 0));
  std::memcpy(image.data(), &header, sizeof header);
  for (std::uint64_t q = 1; q <= count; ++q) {
    const auto to = std::span(image).subspan(recorder::kHeaderBytes + (q - 1) * header.slot_bytes, header.slot_bytes);
    if (!disk_.read(to, place_of(sequence_ - count + q))) return {};
    recorder::SlotHead head;
    std::memcpy(&head, to.data(), sizeof head);
    head.sequence = q;
    head.crc = recorder::crc_of(head, to.subspan(sizeof head, head.bytes));
    std::memcpy(to.data(), &head, sizeof head);
  }
  for (const auto* entry : scenes_from(first_tick_in(image))) {
    recorder::SceneEntry anew = *entry;
    anew.number = (image.size() - file_bytes(header, 0)) / recorder::kSceneBytes + 1;
    anew.crc = recorder::crc_of(anew);
    image.resize(image.size() + recorder::kSceneBytes);
    std::memcpy(image.data() + image.size() - recorder::kSceneBytes, &anew, sizeof anew);
  }
  return image;
}

std::string FlightSlots::save_last(std::int64_t ticks, std::int32_t fault) {
  const auto count = std::min<std::int64_t>({ticks, header_.slots, static_cast<std::int64_t>(sequence_)});
  if (count <= 0 || saved_ >= kMaxSaved) return {};
  std::string path = path_ + ".session-" + std::to_string(header_.session) + ".fault-" + std::to_string(fault) + "." +
                     std::to_string(saved_ + 1);
  const auto image = image_of_last(static_cast<std::uint64_t>(count), fault);
  if (image.empty() || !write_whole_file(path, image)) return {};
  ++saved_;
  return path;
}

}  // namespace ligature::telemetry
