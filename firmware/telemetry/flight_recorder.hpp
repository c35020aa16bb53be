#pragma once
// Every tick on this machine's disk, whatever becomes of the network, the host or this process.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "ligature_msg/tick_t.hpp"
#include "protocol/recorder/flight_file.hpp"

namespace ligature::telemetry {

/// What the file says about itself, so that it can be read alone.
struct FlightFacts {
  std::int64_t session = 0;
  double period_s = 0.001;
  double max_force_N = 0.0;
  std::string firmware_version, scene_file, scene_toml;
};

/// A ring of the newest ticks in a preallocated, memory-mapped file (protocol/recorder/flight_file.hpp).
///
/// write() is a copy into the page cache, which belongs to the kernel: it survives SIGKILL of any process. A thread of
/// its own asks the disk to keep up twice a second, so that a power cut takes at most the last second; a slow disk
/// delays that thread and nobody else. One thread writes. The file of an earlier run is kept once, as FILE.previous.
class FlightRecorder {
 public:
  /// @param slots ticks to keep. @return the recorder, or one line that says why there is none (no room, no right,
  /// another process records into this file).
  [[nodiscard]] static std::variant<std::unique_ptr<FlightRecorder>, std::string> open(const std::string& path,
                                                                                       const FlightFacts& facts,
                                                                                       std::int64_t slots);
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  void write(const ligature_msg::tick_t& tick) noexcept;

  /// The last `ticks` as a file of the same format beside this one, complete or not at all.
  /// @return its path, or nothing when it could not be written or kMaxSaved were.
  [[nodiscard]] std::string save_last(std::int64_t ticks, std::int32_t fault);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  static constexpr int kMaxSaved = 32;  ///< a run; a fault that flaps must not fill the disk

 private:
  FlightRecorder(std::string path, int fd, std::byte* map, std::size_t size, const recorder::Header& header);
  void keep_disk_up();
  [[nodiscard]] std::vector<std::byte> image_of_last(std::uint64_t count, std::int32_t fault);
  [[nodiscard]] std::span<std::byte> slot(std::uint64_t sequence) noexcept;

  std::string path_;
  int fd_;
  std::byte* map_;
  std::size_t size_;
  recorder::Header header_;
  std::uint64_t sequence_ = 0;
  int saved_ = 0;
  std::vector<std::byte> scratch_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;
  std::thread disk_;
};

}  // namespace ligature::telemetry
