#include "host/flight_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "host/errors.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

template <std::size_t N>
std::string text_in(const std::array<char, N>& field) {
  return {field.data(), strnlen(field.data(), N)};
}

bool read_into(std::ifstream& file, void* to, std::size_t bytes) {
  file.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
  return static_cast<std::size_t>(file.gcount()) == bytes;
}

}  // namespace

bool is_flight_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 8> magic{};
  return read_into(file, magic.data(), magic.size()) && magic == recorder::kMagic;
}

FlightReader::FlightReader(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto end = file.tellg();
  if (!file || end < 0) throw BadInput(path + ": cannot be read");
  const auto size = static_cast<std::size_t>(end);
  file.seekg(0);
  std::vector<std::byte> head(recorder::kHeaderBytes);
  if (!read_into(file, head.data(), head.size())) throw BadInput(path + ": shorter than a flight recorder's header");
  std::memcpy(static_cast<void*>(&header_), head.data(), sizeof header_);
  check(path, size);
  ring_.resize(size - recorder::kHeaderBytes);
  if (!read_into(file, ring_.data(), ring_.size())) throw BadInput(path + ": became shorter while it was read");
  index();
}

void FlightReader::check(const std::string& path, std::size_t size) const {
  const auto& h = header_;
  if (h.magic != recorder::kMagic) throw BadInput(path + ": not a flight recorder file");
  if (h.version != recorder::kVersion)
    throw BadInput(path + text(": found flight recorder version %u, allowed %u", h.version, recorder::kVersion));
  if (h.crc != recorder::crc_of(h)) throw BadInput(path + ": the header's CRC is wrong: the file was damaged");
  if (h.tick_hash != ligature_msg::tick_t::getHash())
    throw BadInput(path + ": written with another tick_t, by ligature-firmware " + text_in(h.firmware_version));
  const bool sane = h.slots >= 1 && h.slots <= recorder::kMaxSlots && h.slot_bytes > sizeof(recorder::SlotHead) &&
                    h.slot_bytes <= recorder::kMaxSlotBytes && std::isfinite(h.period_s) && h.period_s > 0.0;
  if (!sane) throw BadInput(path + ": the header makes no sense");
  const std::size_t wanted = recorder::kHeaderBytes + static_cast<std::size_t>(h.slots) * h.slot_bytes;
  if (size != wanted) throw BadInput(path + text(": found %zu bytes, the header says %zu", size, wanted));
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

RigFacts FlightReader::facts() const {
  return {header_.period_s,
          header_.max_force_N,
          true,
          text_in(header_.scene_file),
          text_in(header_.scene_toml),
          text_in(header_.firmware_version)};
}

}  // namespace ligature::host
