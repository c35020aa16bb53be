#pragma once
// Flight recorder: stores every tick on this machine's disk, independent of network and host, also if the process
// crashes.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "firmware/rt/spsc_ring.hpp"
#include "firmware/rt/tick_record.hpp"
#include "firmware/telemetry/flight_slots.hpp"

namespace ligature::telemetry {

/// A message for the user about recorded or lost ticks.
struct FlightNote {
  std::int64_t tick = 0;
  std::int32_t fault = 0;  ///< fault whose preceding ticks were saved; 0: ticks are missing
  std::string text;
};

/// A ring in memory that the loop writes, a thread that copies it to the file, and a thread that syncs the file.
///
///   loop --inlet(), 60 s of ticks--> writer --pwrite, every 5 ms--> page cache --fdatasync, every 0.5 s--> disk
///
/// The loop never waits, nor does telemetry, which has a ring of its own. Data in the page cache survives SIGKILL of
/// any process; synced data survives a power cut. If the disk blocks for longer than the ring lasts, ticks are lost:
/// they are counted, reported in a note, and leave a gap in the file's tick numbers. On a new fault the ticks before it
/// are also saved to a separate file, and a note reports it.
class FlightRecorder {
 public:
  static constexpr std::size_t kRoom = 60'000;  ///< ticks buffered in memory, 45 MB
  static constexpr std::int64_t kTicksPerFault = 2000;
  static constexpr int kMaxNotesOfLoss = 100;  ///< per run; further losses are only counted

  /// @param slots number of ticks to keep. @return the recorder, or one line that says why there is none (no space, no
  /// permission, another process records into this file).
  [[nodiscard]] static std::variant<std::unique_ptr<FlightRecorder>, std::string> open(const std::string& path,
                                                                                       const FlightFacts& facts,
                                                                                       std::int64_t slots);
  /// @param path of the file; saved ticks are put beside it. @param room ticks buffered in memory.
  FlightRecorder(std::unique_ptr<Disk> disk, const std::string& path, const recorder::Header& header,
                 std::size_t room = kRoom);
  ~FlightRecorder() { finish(); }
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// Ring into which one thread, the loop, pushes its records; their ticks start at 0.
  [[nodiscard]] rt::SpscRing<rt::TickRecord>& inlet() noexcept { return inlet_; }

  /// Announces that a change of scene is in progress (the loop may already use the new scene), or that it is over. If a
  /// fault occurs in between, saving its ticks waits up to 0.1 s for scene_changed(), so that the file names the right
  /// scene. Any thread; never waits for the disk.
  void expect_scene(bool expected);
  /// Reports a new scene or parameter with its first tick. Any thread; never waits for the disk.
  void scene_changed(FlightScene scene);

  /// Call after the last record: returns when all records are on the disk. A second call does nothing.
  void finish();

  /// Returns the notes for the user that were made since the last call. Any thread; never waits for the disk.
  [[nodiscard]] std::vector<FlightNote> take_notes();

  /// Ticks that the file lacks for good. Any thread.
  [[nodiscard]] std::int64_t missing() const noexcept { return missing_.load(std::memory_order_relaxed); }
  /// Longest duration of a sync. A power cut loses at most this time plus the 0.5 s between syncs. Any thread.
  [[nodiscard]] std::chrono::milliseconds slowest_sync() const noexcept {
    return std::chrono::milliseconds(slowest_sync_ms_.load(std::memory_order_relaxed));
  }
  [[nodiscard]] const std::string& path() const noexcept { return slots_.path(); }

 private:
  void write_down();
  void take_all();
  void take_scenes();
  void look_for_holes();
  void save(const rt::TickRecord& faulted);
  void lose(std::int64_t count, std::int64_t first, std::int64_t last, const char* why);
  void note(FlightNote what);
  void keep_disk_up();
  [[nodiscard]] bool rest(std::chrono::milliseconds at_most);

  std::unique_ptr<Disk> disk_;
  FlightSlots slots_;
  rt::SpscRing<rt::TickRecord> inlet_;
  // Used by the writer only.
  std::vector<rt::TickRecord> batch_;
  std::int64_t next_tick_ = 0, holes_ = 0;
  std::int16_t fault_ = 0;
  int notes_of_loss_ = 0;
  // Used by several threads.
  std::atomic<std::int64_t> missing_{0}, slowest_sync_ms_{0};
  std::mutex mutex_;  // protects the members below; held only briefly, never during a disk operation
  std::condition_variable wake_;
  bool ending_ = false, scene_expected_ = false;
  std::vector<FlightScene> scenes_;
  std::vector<FlightNote> notes_;
  std::thread writer_, syncer_;
};

}  // namespace ligature::telemetry
