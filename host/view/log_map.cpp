#include "host/view/log_map.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "host/console/progress.hpp"
#include "host/errors.hpp"
#include "host/log_format.hpp"
#include "host/messages.hpp"
#include "host/sync_search.hpp"

namespace ligature::host::view {
namespace {

constexpr std::array kNames{kTicksChannel, kThreadChannel, kStatusChannel, kEventChannel};

/// Turns reception times into a continuous time axis. These are of CLOCK_REALTIME, which may be set during the
/// recording. A step of more than 1 s back or 30 s forward is removed, and so is a pause of more than 30 s without
/// messages. Smaller steps back remain; the entries are sorted later.
class Timeline {
 public:
  std::int64_t place(std::int64_t stamp_us) {
    // limit on times in a forged log: sums must not overflow
    constexpr std::int64_t kFurthest_us = std::int64_t{1} << 61U;
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

/// Bytes read per event: a checksum event, and the head and channel name of the next event.
constexpr std::size_t kGlance = kCheckEventBytes + LogEventHead::kBytes + kLongestChannel;

}  // namespace

std::string_view wire_name(LogMap::Channel channel) { return kNames[static_cast<std::size_t>(channel)]; }

LogMap::LogMap(const std::string& path) : file_(path) {
  scan();
  if (entries_.empty())
    throw BadInput(path + ": found no message of the rig, allowed an LCM log of ligature-host record");
  std::ranges::stable_sort(entries_, {}, &Entry::time_us);
}

void LogMap::scan() {
  constexpr std::size_t kHead = LogEventHead::kBytes;
  console::Progress progress("opening");
  std::array<unsigned char, kGlance> bytes{};
  const auto look = [&](std::int64_t offset) {
    return std::span<const unsigned char>(bytes).first(file_.read_at(bytes.data(), bytes.size(), offset));
  };
  Timeline timeline;
  std::vector<unsigned char> beginning(kBeginning);
  beginning.resize(file_.read_at(beginning.data(), beginning.size(), 0));
  const bool has_checks = has_checksums(beginning);
  for (std::int64_t at = 0; at >= 0 && at < file_.size();) {
    end_when_asked();
    progress.show(at, file_.size());
    auto seen = look(at);
    const auto head = seen.size() >= kHead ? log_event_head(seen.first<kHead>()) : std::nullopt;
    const std::int64_t payload = at + static_cast<std::int64_t>(kHead) + (head ? head->channel_bytes : 0);
    if (!head || payload + head->data_bytes > file_.size()) {
      at = find_sync(file_, at + 1, &progress);
      continue;
    }
    const std::string name(reinterpret_cast<const char*>(seen.data()) + kHead,
                           std::min(static_cast<std::size_t>(head->channel_bytes), seen.size() - kHead));
    const std::int64_t end = payload + head->data_bytes;
    seen = look(end);
    const auto check = log_check(seen);
    const auto known_bytes = std::min(seen.size(), kLogSync.size());
    if (has_checks && !std::ranges::equal(seen.first(known_bytes), std::span(kLogSync).first(known_bytes))) {
      at = find_sync(file_, at + 1, &progress);  // the length field of this event is damaged
      continue;
    }
    at = end + (check ? static_cast<std::int64_t>(kCheckEventBytes) : 0);
    const bool is_own = check && check->timestamp_us == head->timestamp_us;
    if (has_checks && !is_own && seen.size() >= kCheckEventBytes) continue;  // the checksum event is damaged
    const auto known = std::ranges::find(kNames, name);
    if (known == kNames.end()) continue;
    entries_.push_back({timeline.place(head->timestamp_us), payload, static_cast<std::uint32_t>(head->data_bytes),
                        is_own ? check->checksum : 0, static_cast<Channel>(known - kNames.begin()), is_own});
  }
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
  return file_.read_at(payload.data(), payload.size(), entry.offset) == payload.size() &&
         (!entry.has_checksum || entry.checksum == log_checksum(wire_name(entry.channel), payload));
}

}  // namespace ligature::host::view
