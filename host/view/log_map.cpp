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
#include "host/log_format.hpp"
#include "host/messages.hpp"

namespace ligature::host::view {
namespace {

constexpr std::array kNames{kTicksChannel, kThreadChannel, kStatusChannel, kEventChannel};
constexpr std::int64_t kLargestPayload = 16 << 20;

/// Reception times come from the clock on the wall, and somebody may have set it meanwhile: what follows a step of it
/// goes on where the recording stood. So does what follows half a minute without a rig. Small disorder is left to sort.
class Timeline {
 public:
  std::int64_t place(std::int64_t stamp_us) {
    constexpr std::int64_t kFurthest_us = std::int64_t{1} << 61U;  // of a forged log: sums stay within the type
    constexpr std::int64_t kSetBack_us = 1'000'000, kSetForward_us = 30'000'000;
    stamp_us = std::clamp(stamp_us, -kFurthest_us, kFurthest_us);
    if (!last_us_) last_us_ = stamp_us;
    const std::int64_t passed_us = stamp_us + shift_us_ - *last_us_;
    if (passed_us < -kSetBack_us || passed_us > kSetForward_us) shift_us_ -= passed_us;
    const std::int64_t placed_us = stamp_us + shift_us_;
    last_us_ = std::max(*last_us_, placed_us);
    return placed_us;
  }

 private:
  std::optional<std::int64_t> last_us_;
  std::int64_t shift_us_ = 0;
};

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
  std::ranges::stable_sort(entries_, {}, &Entry::time_us);
}

LogMap::~LogMap() { close(file_); }

void LogMap::scan() {
  constexpr std::size_t kHead = LogEventHead::kBytes;
  std::array<unsigned char, kHead + kLongestChannel> bytes{};
  Timeline timeline;
  for (std::int64_t at = 0; at >= 0 && at + static_cast<std::int64_t>(kHead) <= size_;) {
    const std::size_t got = read_at(file_, bytes.data(), bytes.size(), at);
    const auto head = got >= kHead ? log_event_head(std::span(bytes).first<kHead>()) : std::nullopt;
    const std::int64_t payload = at + static_cast<std::int64_t>(kHead) + (head ? head->channel_bytes : 0);
    if (!head || payload + head->data_bytes > size_) {
      at = find_sync(at + 1);
      continue;
    }
    const std::string_view name(reinterpret_cast<const char*>(bytes.data()) + kHead,
                                static_cast<std::size_t>(head->channel_bytes));
    const auto known = std::ranges::find(kNames, name);
    if (known != kNames.end() && head->data_bytes <= kLargestPayload)
      entries_.push_back({timeline.place(head->timestamp_us), payload, static_cast<std::uint32_t>(head->data_bytes),
                          static_cast<Channel>(known - kNames.begin())});
    at = payload + head->data_bytes;
  }
}

/// Offset of the next sync word at or after an offset, -1 when there is none.
std::int64_t LogMap::find_sync(std::int64_t from) const {
  std::vector<unsigned char> block(1U << 16U);
  for (std::int64_t at = from; at < size_;) {
    const std::size_t got = read_at(file_, block.data(), block.size(), at);
    if (got < kLogSync.size()) return -1;
    const auto end = block.begin() + static_cast<std::ptrdiff_t>(got);
    const auto found = std::search(block.begin(), end, kLogSync.begin(), kLogSync.end());
    if (found != end) return at + (found - block.begin());
    at += static_cast<std::int64_t>(got - (kLogSync.size() - 1));  // the word may lie across two blocks
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
