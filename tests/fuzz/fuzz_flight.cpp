// Fuzz target: flight recorder files. Half of the inputs get a valid header CRC, which random mutations would never
// have.
#include <cstring>

#include "host/errors.hpp"
#include "host/flight_reader.hpp"
#include "tests/fuzz/target.hpp"

namespace ligature {
namespace {

recorder::Header header_in(const std::string& bytes) {
  recorder::Header h;
  std::memcpy(static_cast<void*>(&h), bytes.data(), sizeof h);
  return h;
}
void put(std::string& bytes, recorder::Header h) {
  h.crc = recorder::crc_of(h);
  std::memcpy(bytes.data(), &h, sizeof h);
}

}  // namespace

std::vector<std::string> fuzz::seeds() {
  std::string bytes(recorder::kHeaderBytes, '\0');
  recorder::Header h;
  std::memset(static_cast<void*>(&h), 0, sizeof h);
  h.magic = recorder::kMagic;
  h.version = recorder::kVersion;
  h.slot_bytes = recorder::slot_bytes_for(static_cast<std::size_t>(ligature_msg::tick_t{}._getEncodedSizeNoHash()));
  h.slots = 4;
  h.tick_hash = ligature_msg::tick_t::getHash();
  h.period_s = 0.001;
  put(bytes, h);
  bytes.resize(recorder::kHeaderBytes + 4U * h.slot_bytes);
  for (std::uint64_t q = 1; q <= 3; ++q) {
    const std::vector<std::byte> payload(static_cast<std::size_t>(ligature_msg::tick_t{}._getEncodedSizeNoHash()));
    recorder::SlotHead head{q, static_cast<std::uint32_t>(payload.size()), 0};
    head.crc = recorder::crc_of(head, payload);
    std::memcpy(bytes.data() + recorder::kHeaderBytes + recorder::slot_of(q, 4) * h.slot_bytes, &head, sizeof head);
  }
  return {bytes};
}

}  // namespace ligature

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ligature;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size >= sizeof(recorder::Header) && size % 2 == 0) put(bytes, header_in(bytes));
  const fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (!host::is_flight_file(file.path())) return 0;
  try {
    const host::FlightReader reader(file.path());
    std::size_t seen = 0;
    reader.visit([&](const auto&) { ++seen; });
    (void)reader.facts();
  } catch (const host::BadInput&) {  // rejected, as it should be
  }
  return 0;
}
