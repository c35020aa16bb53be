#include "firmware/telemetry/flight_slots.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "firmware/telemetry/messages.hpp"

namespace ligature::telemetry {
namespace {

constexpr std::size_t kAtOnce = 64;  // slots a write: 32 kB

/// One slot, all of it.
void encode(const rt::TickRecord& record, std::uint64_t sequence, std::span<std::byte> slot) {
  const auto payload = slot.subspan(sizeof(recorder::SlotHead));
  const int n = to_message(record)._encodeNoHash(payload.data(), 0, static_cast<int>(payload.size()));
  const auto bytes = static_cast<std::size_t>(n);  // never too little room: slot_bytes_for() was asked
  std::ranges::fill(payload.subspan(bytes), std::byte{0});
  recorder::SlotHead head{sequence, static_cast<std::uint32_t>(bytes), 0};
  head.crc = recorder::crc_of(head, payload.first(bytes));
  std::memcpy(slot.data(), &head, sizeof head);
}

}  // namespace

recorder::Header header_of(const FlightFacts& facts, std::int64_t slots) {
  recorder::Header h;
  std::memset(static_cast<void*>(&h), 0, sizeof h);  // gaps between members count in the CRC
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

std::size_t file_bytes(const recorder::Header& header) {
  return recorder::kHeaderBytes + static_cast<std::size_t>(header.slots) * header.slot_bytes;
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

/// Records are numbered anew, from 1, so that the file is as small as what it holds.
std::vector<std::byte> FlightSlots::image_of_last(std::uint64_t count, std::int32_t fault) {
  recorder::Header header = header_;
  header.slots = static_cast<std::int64_t>(count);
  header.fault = fault;
  header.crc = recorder::crc_of(header);
  std::vector<std::byte> image(file_bytes(header));
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
