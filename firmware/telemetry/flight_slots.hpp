#pragma once
// The slots of a flight recorder file (protocol/recorder/flight_file.hpp): a ring of the newest ticks.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "firmware/rt/tick_record.hpp"
#include "firmware/telemetry/disk.hpp"
#include "protocol/recorder/flight_file.hpp"

namespace ligature::telemetry {

/// Description of the run, stored in the file's header so that the file can be read on its own.
struct FlightFacts {
  std::int64_t session = 0;
  double period_s = 0.001;
  double max_force_N = 0.0;
  std::string firmware_version, scene_file, scene_toml;
};

/// A scene or parameter change during the run.
struct FlightScene {
  std::int64_t first_tick = 0;
  double max_force_N = 0.0;
  bool admitted = true;
  std::string scene_file, scene_toml;
};

/// Header of a new flight recorder file. @param slots number of ticks to keep.
[[nodiscard]] recorder::Header header_of(const FlightFacts& facts, std::int64_t slots);
/// Size of the file. @param scenes number of scene entries.
[[nodiscard]] std::size_t file_bytes(const recorder::Header& header, std::size_t scenes = recorder::kMostScenes);

/// Not thread-safe; calls wait for the disk.
class FlightSlots {
 public:
  static constexpr int kMaxSaved = 32;  ///< per run; so that a recurring fault does not fill the disk

  /// Writes the header. @param path of the file; saved ticks are put beside it.
  FlightSlots(std::string path, Disk& disk, const recorder::Header& header);

  /// @return how many records the disk did not accept; these are lost.
  std::size_t append(std::span<const rt::TickRecord> records);

  /// Adds a scene with its first tick; the newest kMostScenes are kept.
  void add(const FlightScene& scene);

  /// Saves the last `ticks` records, and the scenes in force during them, as a complete file of the same format beside
  /// this one.
  /// @return its path, or an empty string if writing failed or kMaxSaved files exist already
  [[nodiscard]] std::string save_last(std::int64_t ticks, std::int32_t fault);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  [[nodiscard]] std::size_t place_of(std::uint64_t sequence) const noexcept;
  [[nodiscard]] std::vector<const recorder::SceneEntry*> scenes_from(std::int64_t tick) const;
  [[nodiscard]] std::vector<std::byte> image_of_last(std::uint64_t count, std::int32_t fault);

  std::string path_;
  Disk& disk_;
  recorder::Header header_;
  std::uint64_t sequence_ = 0;
  int saved_ = 0;
  std::deque<recorder::SceneEntry> scenes_;  // the newest ones, oldest first
  std::uint64_t scene_number_ = 0;
  std::vector<std::byte> scratch_;
};

}  // namespace ligature::telemetry
