#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/log_writer.hpp"
#include "host/messages.hpp"

namespace ligature::host::test {

/// A temporary folder for one test, removed afterwards.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  [[nodiscard]] std::string file(std::string_view name) const { return (path_ / name).string(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A tick whose fields are zero except for its number and "no node held".
[[nodiscard]] ligature_msg::tick_t tick_of(std::int64_t number);

/// Consecutive ticks first .. first + count - 1.
[[nodiscard]] ligature_msg::tick_batch_t batch_of(std::int64_t session, std::int64_t first, int count);

/// A thread along a polyline.
[[nodiscard]] ligature_msg::thread_t thread_of(std::int64_t tick, const std::vector<std::array<double, 3>>& points);

/// An open overhand knot with long ends; closing it gives a trefoil.
[[nodiscard]] std::vector<std::array<double, 3>> overhand_points(int count);
[[nodiscard]] std::vector<std::array<double, 3>> straight_points(int count);

template <class M>
std::vector<std::byte> encoded(const M& message) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

template <class M>
void write(LogWriter& log, std::string_view channel, const M& message) {
  log.write(message.utime, channel, encoded(message));
}

[[nodiscard]] std::string text_of(const std::string& path);
[[nodiscard]] std::vector<std::string> lines_of(const std::string& path);
void write_text(const std::string& path, std::string_view text);

}  // namespace ligature::host::test
