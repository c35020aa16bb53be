#pragma once
// Every tick on this machine's disk, whatever becomes of the network, the host, this process or the disk's patience.

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

/// What became of ticks, for people.
struct FlightNote {
  std::int64_t tick = 0;
  std::int32_t fault = 0;  ///< whose ticks were saved; 0: ticks are missing
  std::string text;
};

/// A ring of memory that the loop writes into, a thread that takes it to the disk, and a thread that asks the disk to
/// keep up.
///
///   loop --inlet(), 60 s of ticks--> writer --pwrite, every 5 ms--> page cache --fdatasync, every 0.5 s--> disk
///
/// The loop never waits; neither does telemetry, which has a ring of its own. What is in the page cache survives
/// SIGKILL of any process, what is synced a power cut. A disk that stands still for longer than the ring lasts costs
/// ticks: counted, named in a note, and a hole in the numbers of the file. A new fault saves the ticks before it to a
/// file of their own; that is noted, too.
class FlightRecorder {
 public:
  static constexpr std::size_t kRoom = 60'000;  ///< ticks in memory, 45 MB
  static constexpr std::int64_t kTicksPerFault = 2000;
  static constexpr int kMaxNotesOfLoss = 100;  ///< a run; all are counted

  /// @param slots ticks to keep. @return the recorder, or one line that says why there is none (no room, no right,
  /// another process records into this file).
  [[nodiscard]] static std::variant<std::unique_ptr<FlightRecorder>, std::string> open(const std::string& path,
                                                                                       const FlightFacts& facts,
                                                                                       std::int64_t slots);
  /// @param path of the file, for its neighbours. @param room ticks in memory.
  FlightRecorder(std::unique_ptr<Disk> disk, const std::string& path, const recorder::Header& header,
                 std::size_t room = kRoom);
  ~FlightRecorder() { finish(); }
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  /// Where one thread, the loop, puts its records; their ticks count from 0 on.
  [[nodiscard]] rt::SpscRing<rt::TickRecord>& inlet() noexcept { return inlet_; }

  /// A change of scene is under way: the loop may have taken it before scene_changed() says so. What is saved with a
  /// fault waits for that, for a moment at most. Any thread; never waits for the disk.
  void expect_scene(bool expected);
  /// Another scene or parameter is in force since its first tick. Any thread; never waits for the disk.
  void scene_changed(FlightScene scene);

  /// After the last record: returns when all are on the disk. The second time it does nothing.
  void finish();

  /// What has happened since the last call. Any thread; never waits for the disk.
  [[nodiscard]] std::vector<FlightNote> take_notes();

  /// Ticks that are not in the file and never will be. Any thread.
  [[nodiscard]] std::int64_t missing() const noexcept { return missing_.load(std::memory_order_relaxed); }
  /// What a power cut would have cost at the worst moment, beside the half second between two of them. Any thread.
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
  // of the writer
  std::vector<rt::TickRecord> batch_;
  std::int64_t next_tick_ = 0, holes_ = 0;
  std::int16_t fault_ = 0;
  int notes_of_loss_ = 0;
  // of all
  std::atomic<std::int64_t> missing_{0}, slowest_sync_ms_{0};
  std::mutex mutex_;  // of what follows; held for a moment only, never over a call to the disk
  std::condition_variable wake_;
  bool ending_ = false, scene_expected_ = false;
  std::vector<FlightScene> scenes_;
  std::vector<FlightNote> notes_;
  std::thread writer_, syncer_;
};

}  // namespace ligature::telemetry
