#include "host/log_reader.hpp"

#include <algorithm>

#include "host/errors.hpp"
#include "host/sync_search.hpp"

namespace ligature::host {

LogReader::LogReader(const std::string& path, console::Progress* progress) : file_(path), progress_(progress) {
  if (file_.size() == 0) throw BadInput(path + ": empty file; allowed: an LCM log of ligature-host record");
  if (!std::ranges::equal(window_.at(0, kLogSync.size()), kLogSync))
    throw BadInput(path +
                   ": not an LCM log (does not begin with ED A1 DA 01); allowed: a file of ligature-host record");
  has_checks_ = has_checksums(window_.at(0, kBeginning));
}

const LogEvent* LogReader::next() {
  end_when_asked();
  if (progress_ != nullptr) progress_->show(offset_, size());
  for (std::int64_t candidate = offset_; candidate >= 0;) {
    const std::int64_t before = offset_;
    const bool is_sound = read_event_at(candidate);
    // bytes before an event that was found, or dropped as damaged
    if (offset_ > before) skipped_bytes_ += candidate - before;
    if (is_sound) {
      ++events_;
      return &event_;
    }
    candidate = find_sync(file_, std::max(candidate, offset_ - 1) + 1, progress_);
  }
  tail_bytes_ += size() - offset_;  // no intact event follows
  offset_ = size();
  return nullptr;
}

/// Reads the event at `offset` into event_, or the next one if events there must be dropped (wrong checksum, or a
/// checksum event of another recorder). False when there is no event at that place.
bool LogReader::read_event_at(std::int64_t offset) {
  constexpr auto kHead = static_cast<std::int64_t>(LogEventHead::kBytes);
  for (;;) {
    end_when_asked();
    if (size() - offset < kHead) return false;
    const auto first = window_.at(offset, LogEventHead::kBytes);
    const auto head =
        first.size() == LogEventHead::kBytes ? log_event_head(first.first<LogEventHead::kBytes>()) : std::nullopt;
    if (!head) return false;
    const std::int64_t whole = kHead + head->channel_bytes + head->data_bytes;
    if (whole > size() - offset) return false;

    const auto bytes = window_.at(offset, static_cast<std::size_t>(whole) + kCheckEventBytes);
    if (static_cast<std::int64_t>(bytes.size()) < whole) return false;  // the file was shortened meanwhile
    const auto named = static_cast<std::size_t>(head->channel_bytes);
    const std::string_view channel(reinterpret_cast<const char*>(bytes.data()) + kHead, named);
    if (!std::ranges::all_of(channel, [](char c) { return c >= ' ' && c <= '~'; })) return false;
    const auto data = std::as_bytes(
        bytes.subspan(static_cast<std::size_t>(kHead) + named, static_cast<std::size_t>(head->data_bytes)));
    const auto behind = bytes.subspan(static_cast<std::size_t>(whole));
    if (!has_checks_ && channel == kCheckChannel) {  // checksum event of a log that was played back and recorded again
      offset_ = offset += whole;
      continue;
    }
    // the event that this checksum belongs to is damaged
    if (has_checks_ && (channel == kCheckChannel || !is_whole(behind))) return false;
    const auto check = log_check(behind);
    const bool is_own = check && check->timestamp_us == head->timestamp_us;
    offset_ = offset +=
        whole + (check || (has_checks_ && is_like_check(behind)) ? static_cast<std::int64_t>(kCheckEventBytes) : 0);
    if (is_own && check->checksum != log_checksum(channel, data)) {
      ++damaged_;
    } else if (has_checks_ && !is_own && behind.size() >= kCheckEventBytes) {
      ++unchecked_;
    } else {
      event_ = {head->timestamp_us, channel, data};
      return true;
    }
  }
}

/// Whether an event's length field is plausible, judged by the bytes `behind` the event. In a log with checksums these
/// bytes begin the next event, or the file ends there (recorder killed). Otherwise the length field is damaged, and
/// using it would skip intact events.
bool LogReader::is_whole(std::span<const unsigned char> behind) {
  const auto known = std::min(behind.size(), kLogSync.size());
  return std::ranges::equal(behind.first(known), std::span(kLogSync).first(known));
}

/// Whether the bytes `behind` an event are a checksum event whose name, time or sum is damaged.
bool LogReader::is_like_check(std::span<const unsigned char> behind) {
  if (behind.size() < kCheckEventBytes) return false;
  const auto head = log_event_head(behind.first<LogEventHead::kBytes>());
  return head && head->channel_bytes == static_cast<std::int32_t>(kCheckChannel.size()) &&
         head->data_bytes == static_cast<std::int32_t>(kCheckBytes);
}

std::string LogReader::damage() const {
  std::string line;
  const auto say = [&line](const std::string& words) { line += (line.empty() ? "" : "; ") + words; };
  if (damaged_ > 0) say(std::to_string(damaged_) + " damaged records left out (wrong checksum)");
  if (unchecked_ > 0) say(std::to_string(unchecked_) + " records left out whose checksum is damaged");
  if (skipped_bytes_ > 0) say(std::to_string(skipped_bytes_) + " broken bytes skipped");
  if (is_truncated())
    say("file ends inside an event (recorder killed?): read up to the last whole one, " + std::to_string(tail_bytes_) +
        " bytes left out");
  return line;
}

}  // namespace ligature::host
