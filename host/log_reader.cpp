#include "host/log_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "host/errors.hpp"

namespace ligature::host {
namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::int64_t kHeaderSize = 28;
constexpr std::int64_t kLongestChannel = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH

template <class T>
T big_endian(const unsigned char* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = value << 8U | bytes[i];
  return static_cast<T>(value);
}

}  // namespace

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
  if (!has_start || big_endian<std::uint32_t>(start.data()) != kSync)
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
  std::array<unsigned char, kHeaderSize> header{};
  if (size_ - offset < kHeaderSize) return false;
  // In sequence the stream stands there already; seeking would throw its buffer away.
  if (std::ftell(file_.get()) != offset) std::fseek(file_.get(), static_cast<long>(offset), SEEK_SET);
  if (std::fread(header.data(), 1, header.size(), file_.get()) != header.size()) return false;
  if (big_endian<std::uint32_t>(header.data()) != kSync) return false;
  const std::int64_t channel_size = big_endian<std::int32_t>(header.data() + 20);
  const std::int64_t data_size = big_endian<std::int32_t>(header.data() + 24);
  if (channel_size < 1 || channel_size > kLongestChannel || data_size < 0) return false;
  if (channel_size + data_size > size_ - offset - kHeaderSize) return false;

  channel_.resize(static_cast<std::size_t>(channel_size));
  payload_.resize(static_cast<std::size_t>(data_size));
  if (std::fread(channel_.data(), 1, channel_.size(), file_.get()) != channel_.size()) return false;
  if (std::fread(payload_.data(), 1, payload_.size(), file_.get()) != payload_.size()) return false;
  if (!std::ranges::all_of(channel_, [](char c) { return c >= ' ' && c <= '~'; })) return false;
  event_ = {big_endian<std::int64_t>(header.data() + 12), channel_, payload_};
  offset_ = offset + kHeaderSize + channel_size + data_size;
  return true;
}

/// Offset of the next sync word at or after an offset, -1 when there is none.
std::int64_t LogReader::find_sync(std::int64_t from) {
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
