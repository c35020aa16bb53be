#include "host/log_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "host/errors.hpp"
#include "host/log_format.hpp"

namespace ligature::host {

LogReader::LogReader(const std::string& path) {
  std::error_code why;
  if (!std::filesystem::is_regular_file(path, why))
    throw BadInput(path + ": " + (why ? why.message() : "not a file") +
                   "; allowed: an LCM log of ligature-host record");
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_) throw BadInput(path + ": " + std::strerror(errno));
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(path));
  std::array<unsigned char, 4> start{};
  const bool has_start = std::fread(start.data(), 1, start.size(), file_.get()) == start.size();
  if (size_ == 0) throw BadInput(path + ": empty file; allowed: an LCM log of ligature-host record");
  if (!has_start || start != kLogSync)
    throw BadInput(path +
                   ": not an LCM log (does not begin with ED A1 DA 01); allowed: a file of ligature-host record");
}

const LogEvent* LogReader::next() {
  const std::int64_t expected_at = offset_;
  std::int64_t candidate = expected_at;
  while (candidate >= 0 && !read_event_at(candidate)) candidate = find_sync(candidate + 1);
  if (candidate < 0) {  // nothing sound follows
    tail_bytes_ += size_ - expected_at;
    offset_ = size_;
    return nullptr;
  }
  skipped_bytes_ += candidate - expected_at;
  ++events_;
  return &event_;
}

/// Reads the event whose header starts at an offset into event_; false when there is no whole, sound one.
bool LogReader::read_event_at(std::int64_t offset) {
  std::array<unsigned char, LogEventHead::kBytes> bytes{};
  constexpr auto kHead = static_cast<std::int64_t>(bytes.size());
  if (size_ - offset < kHead) return false;
  // In sequence the stream stands there already; seeking would throw its buffer away.
  if (std::ftell(file_.get()) != offset) std::fseek(file_.get(), static_cast<long>(offset), SEEK_SET);
  if (std::fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return false;
  const auto head = log_event_head(bytes);
  if (!head) return false;
  const std::int64_t rest = std::int64_t{head->channel_bytes} + head->data_bytes;
  if (rest > size_ - offset - kHead) return false;

  channel_.resize(static_cast<std::size_t>(head->channel_bytes));
  payload_.resize(static_cast<std::size_t>(head->data_bytes));
  if (std::fread(channel_.data(), 1, channel_.size(), file_.get()) != channel_.size()) return false;
  if (std::fread(payload_.data(), 1, payload_.size(), file_.get()) != payload_.size()) return false;
  if (!std::ranges::all_of(channel_, [](char c) { return c >= ' ' && c <= '~'; })) return false;
  event_ = {head->timestamp_us, channel_, payload_};
  offset_ = offset + kHead + rest;
  return true;
}

/// Offset of the next sync word at or after an offset, -1 when there is none.
std::int64_t LogReader::find_sync(std::int64_t from) {
  constexpr std::uint32_t kSync = 0xEDA1DA01;
  std::fseek(file_.get(), static_cast<long>(from), SEEK_SET);
  std::uint32_t window = 0;
  for (std::int64_t at = from; at < size_; ++at) {
    const int byte = std::fgetc(file_.get());
    if (byte == EOF) return -1;
    window = window << 8U | static_cast<std::uint32_t>(byte);
    if (at - from >= 3 && window == kSync) return at - 3;
  }
  return -1;
}

std::string LogReader::damage() const {
  std::string text;
  if (skipped_bytes_ > 0) text = std::to_string(skipped_bytes_) + " broken bytes skipped";
  if (is_truncated()) {
    if (!text.empty()) text += "; ";
    text += "file ends inside an event (recorder killed?): read up to the last whole one, " +
            std::to_string(tail_bytes_) + " bytes left out";
  }
  return text;
}

}  // namespace ligature::host
