#pragma once
// Ticks as slots of a flight recorder file (protocol/recorder/flight_file.hpp): a ring of the newest ones.

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

/// What the file says about itself, so that it can be read alone.
struct FlightFacts {
  std::int64_t session = 0;
  double period_s = 0.001;
  double max_force_N = 0.0;
  std::string firmware_version, scene_file, scene_toml;
};

/// A scene that came in force while the rig ran.
struct FlightScene {
  std::int64_t first_tick = 0;
  double max_force_N = 0.0;
  bool admitted = true;
  std::string scene_file, scene_toml;
};

/// @param slots ticks to keep.
[[nodiscard]] recorder::Header header_of(const FlightFacts& facts, std::int64_t slots);
/// @param scenes that the file has room for.
[[nodiscard]] std::size_t file_bytes(const recorder::Header& header, std::size_t scenes = recorder::kMostScenes);

/// One thread uses it; it waits for the disk.
class FlightSlots {
 public:
  static constexpr int kMaxSaved = 32;  ///< a run; a fault that flaps must not fill the disk

  /// Writes the header. @param path of the file, which saved ticks are put beside.
  FlightSlots(std::string path, Disk& disk, const recorder::Header& header);

  /// @return how many of them the disk did not take; these are not in the file.
  std::size_t append(std::span<const rt::TickRecord> records);

  /// From its first tick on; the last kMostScenes of them are kept.
  void add(const FlightScene& scene);

  /// The last `ticks`, and the scenes in force at them, as a file of the same format beside this one, complete or not
  /// at all.
  /// @return its path, or nothing when it could not be written or kMaxSaved were.
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
  std::deque<recorder::SceneEntry> scenes_;  // the newest, oldest first
  std::uint64_t scene_number_ = 0;
  std::vector<std::byte> scratch_;
};

}  // namespace ligature::telemetry
