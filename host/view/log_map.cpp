#include "host/view/log_map.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "host/errors.hpp"
#include "host/messages.hpp"

namespace ligature::host::view {
namespace {

constexpr std::array<unsigned char, 4> kSync{0xED, 0xA1, 0xDA, 0x01};
constexpr std::size_t kHeader = 28, kLongestChannel = 63;
constexpr std::array kNames{kTicksChannel, kThreadChannel, kStatusChannel, kEventChannel};
constexpr std::int64_t kLargestPayload = 16 << 20;

template <class T>
T big_endian(const unsigned char* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = value << 8U | bytes[i];
  return static_cast<T>(value);
}

std::size_t read_at(int file, void* to, std::size_t size, std::int64_t offset) {
  const ssize_t got = pread(file, to, size, offset);
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

}  // namespace

std::string_view wire_name(LogMap::Channel channel) { return kNames[static_cast<std::size_t>(channel)]; }

LogMap::LogMap(const std::string& path) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat facts = {};
  if (file_ < 0 || fstat(file_, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    const std::string why = file_ < 0 ? std::strerror(errno) : "not a file";
    if (file_ >= 0) close(file_);
    throw BadInput(path + ": " + why + "; allowed: an LCM log of ligature-host record");
  }
  size_ = facts.st_size;
  scan();
  if (entries_.empty()) {
    close(file_);
    throw BadInput(path + ": found no message of the rig, allowed an LCM log of ligature-host record");
  }
  // Reception times of one host: in order but for a clock that was set back.
  std::ranges::stable_sort(entries_, {}, &Entry::time_us);
}

LogMap::~LogMap() { close(file_); }

void LogMap::scan() {
  std::array<unsigned char, kHeader + kLongestChannel> bytes{};
  for (std::int64_t at = 0; at >= 0 && at + static_cast<std::int64_t>(kHeader) <= size_;) {
    const std::size_t got = read_at(file_, bytes.data(), bytes.size(), at);
    const auto channel_size = big_endian<std::int32_t>(bytes.data() + 20);
    const auto data_size = big_endian<std::int32_t>(bytes.data() + 24);
    const bool is_event = got >= kHeader && std::equal(kSync.begin(), kSync.end(), bytes.begin()) && channel_size > 0 &&
                          channel_size <= static_cast<int>(kLongestChannel) && data_size >= 0;
    const std::int64_t payload = at + static_cast<std::int64_t>(kHeader) + channel_size;
    if (!is_event || payload + data_size > size_) {
      at = find_sync(at + 1);
      continue;
    }
    const std::string_view name(reinterpret_cast<const char*>(bytes.data()) + kHeader,
                                static_cast<std::size_t>(channel_size));
    const auto known = std::ranges::find(kNames, name);
    if (known != kNames.end() && data_size <= kLargestPayload)
      entries_.push_back({big_endian<std::int64_t>(bytes.data() + 12), payload, static_cast<std::uint32_t>(data_size),
                          static_cast<Channel>(known - kNames.begin())});
    at = payload + data_size;
  }
}

/// Offset of the next sync word at or after an offset, -1 when there is none.
std::int64_t LogMap::find_sync(std::int64_t from) const {
  std::vector<unsigned char> block(1U << 16U);
  for (std::int64_t at = from; at < size_;) {
    const std::size_t got = read_at(file_, block.data(), block.size(), at);
    if (got < kSync.size()) return -1;
    const auto end = block.begin() + static_cast<std::ptrdiff_t>(got);
    const auto found = std::search(block.begin(), end, kSync.begin(), kSync.end());
    if (found != end) return at + (found - block.begin());
    at += static_cast<std::int64_t>(got - (kSync.size() - 1));  // the word may lie across two blocks
  }
  return -1;
}

double LogMap::time_s(std::int64_t time_us) const {
  return static_cast<double>(time_us - entries_.front().time_us) * 1e-6;
}

std::size_t LogMap::after(double t_s) const {
  const auto found = std::ranges::upper_bound(entries_, t_s, {}, [this](const Entry& e) { return time_s(e.time_us); });
  return static_cast<std::size_t>(found - entries_.begin());
}

bool LogMap::read(const Entry& entry, std::vector<std::byte>& payload) const {
  payload.resize(entry.size);
  return read_at(file_, payload.data(), payload.size(), entry.offset) == payload.size();
}

}  // namespace ligature::host::view
