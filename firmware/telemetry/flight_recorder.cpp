#include "firmware/telemetry/flight_recorder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <utility>

namespace ligature::telemetry {
namespace {

constexpr auto kDiskPeriod = std::chrono::milliseconds(500);

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

std::string refusal(const std::string& path, const char* what, int error) {
  return "flight recorder " + path + ": " + what + " (" + std::strerror(error) + ")";
}

/// Whether somebody alive records into that file.
bool is_in_use(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = flock(fd, LOCK_EX | LOCK_NB) != 0;
  close(fd);
  return locked;
}

bool write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace

std::variant<std::unique_ptr<FlightRecorder>, std::string> FlightRecorder::open(const std::string& path,
                                                                                const FlightFacts& facts,
                                                                                std::int64_t slots) {
  if (is_in_use(path)) return "flight recorder " + path + ": another process records into it";
  std::rename(path.c_str(), (path + ".previous").c_str());  // there may be none
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) return refusal(path, "cannot be made", errno);
  const auto header = header_of(facts, slots);
  const std::size_t size = recorder::kHeaderBytes + static_cast<std::size_t>(slots) * header.slot_bytes;
  const auto give_up = [&](const char* what, int error) {
    close(fd);
    unlink(path.c_str());
    return refusal(path, what, error);
  };
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) return give_up("cannot be locked", errno);
  // Blocks are taken now: a disk that fills up later can neither lose a tick nor kill us by SIGBUS.
  if (const int e = posix_fallocate(fd, 0, static_cast<off_t>(size)); e != 0) return give_up("no room", e);
  void* map = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (map == MAP_FAILED) return give_up("cannot be mapped", errno);
  std::memcpy(map, &header, sizeof header);
  return std::unique_ptr<FlightRecorder>(new FlightRecorder(path, fd, static_cast<std::byte*>(map), size, header));
}

FlightRecorder::FlightRecorder(std::string path, int fd, std::byte* map, std::size_t size,
                               const recorder::Header& header)
    : path_(std::move(path)), fd_(fd), map_(map), size_(size), header_(header), scratch_(header.slot_bytes) {
  disk_ = std::thread([this] { keep_disk_up(); });
}

FlightRecorder::~FlightRecorder() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  disk_.join();
  munmap(map_, size_);
  close(fd_);
}

void FlightRecorder::keep_disk_up() {
  std::unique_lock lock(mutex_);
  for (bool last = false; !last;) {
    last = wake_.wait_for(lock, kDiskPeriod, [this] { return ending_; });
    lock.unlock();
    fdatasync(fd_);
    lock.lock();
  }
}

std::span<std::byte> FlightRecorder::slot(std::uint64_t sequence) noexcept {
  const auto at = recorder::kHeaderBytes + recorder::slot_of(sequence, header_.slots) * header_.slot_bytes;
  return {map_ + at, header_.slot_bytes};
}

void FlightRecorder::write(const ligature_msg::tick_t& tick) noexcept {
  const auto room = static_cast<int>(scratch_.size() - sizeof(recorder::SlotHead));
  const int n = tick._encodeNoHash(scratch_.data() + sizeof(recorder::SlotHead), 0, room);
  if (n < 0) return;
  const auto bytes = static_cast<std::size_t>(n);
  recorder::SlotHead head{++sequence_, static_cast<std::uint32_t>(bytes), 0};
  head.crc = recorder::crc_of(head, std::span(scratch_).subspan(sizeof head, bytes));
  std::memcpy(scratch_.data(), &head, sizeof head);
  std::memcpy(slot(sequence_).data(), scratch_.data(), sizeof head + bytes);
}

/// Records are numbered anew, from 1, so that the file is as small as what it holds.
std::vector<std::byte> FlightRecorder::image_of_last(std::uint64_t count, std::int32_t fault) {
  recorder::Header header = header_;
  header.slots = static_cast<std::int64_t>(count);
  header.fault = fault;
  header.crc = recorder::crc_of(header);
  std::vector<std::byte> image(recorder::kHeaderBytes + count * header.slot_bytes);
  std::memcpy(image.data(), &header, sizeof header);
  for (std::uint64_t q = 1; q <= count; ++q) {
    const auto to = std::span(image).subspan(recorder::kHeaderBytes + (q - 1) * header.slot_bytes, header.slot_bytes);
    std::ranges::copy(slot(sequence_ - count + q), to.begin());
    recorder::SlotHead head;
    std::memcpy(&head, to.data(), sizeof head);
    head.sequence = q;
    head.crc = recorder::crc_of(head, to.subspan(sizeof head, head.bytes));
    std::memcpy(to.data(), &head, sizeof head);
  }
  return image;
}

std::string FlightRecorder::save_last(std::int64_t ticks, std::int32_t fault) {
  const auto count = std::min<std::int64_t>({ticks, header_.slots, static_cast<std::int64_t>(sequence_)});
  if (count <= 0 || saved_ >= kMaxSaved) return {};
  std::string path = path_ + ".session-" + std::to_string(header_.session) + ".fault-" + std::to_string(fault) + "." +
                     std::to_string(saved_ + 1);
  const std::string draft = path + ".tmp";
  const int fd = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return {};
  const bool written = write_all(fd, image_of_last(static_cast<std::uint64_t>(count), fault)) && fdatasync(fd) == 0;
  close(fd);
  if (!written || std::rename(draft.c_str(), path.c_str()) != 0) {
    unlink(draft.c_str());
    return {};
  }
  ++saved_;
  return path;
}

}  // namespace ligature::telemetry
