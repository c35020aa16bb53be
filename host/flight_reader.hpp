#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/regular_file.hpp"
#include "host/rig_facts.hpp"
#include "ligature_msg/tick_t.hpp"
#include "protocol/recorder/flight_file.hpp"

namespace ligature::host {

/// Whether the file starts with a flight recorder's header; false when it cannot be read.
[[nodiscard]] bool is_flight_file(const std::string& path);

/// The session in a flight recorder's header; reads nothing else. Empty when the header is invalid.
[[nodiscard]] std::optional<std::int64_t> session_of(const RegularFile& file);

/// Reads the present content of a flight recorder file, also while it is being written, into memory (0.7 MB for each
/// second). Slots with a wrong CRC are counted and skipped; a writer that dies leaves at most one such slot.
class FlightReader {
 public:
  /// @throws BadInput when it is no flight recorder file, has another version, or is shorter than its header says.
  explicit FlightReader(const std::string& path);
  /// Reads a file that is already open; `path` is its name in messages.
  FlightReader(const RegularFile& file, const std::string& path);

  /// Calls `take` for every valid tick, oldest first.
  void visit(const std::function<void(const ligature_msg::tick_t&)>& take) const;

  [[nodiscard]] std::int64_t session() const { return header_.session; }
  [[nodiscard]] std::int32_t fault() const { return header_.fault; }  ///< fault code at the time of saving; 0 = none
  [[nodiscard]] std::size_t ticks() const { return sound_.size(); }
  [[nodiscard]] std::int64_t damaged_slots() const { return damaged_; }
  /// The scene in force at the oldest tick.
  [[nodiscard]] RigFacts facts() const;

  /// A scene with its overrides, and the first tick for which it was in force.
  struct Scene {
    std::int64_t first_tick = 0;
    RigFacts facts;
    bool admitted = true;  ///< false: admission failed, and the run was started with --force
  };
  /// The scenes of the run in order of time. The first is the scene in force at the start of the run, or at the oldest
  /// tick that is known.
  [[nodiscard]] const std::vector<Scene>& scenes() const { return scenes_; }
  [[nodiscard]] const Scene& scene_at(std::int64_t tick) const;

 private:
  void read_scenes(std::span<const std::byte> entries);
  [[nodiscard]] std::int64_t oldest_tick() const;
  void check(const std::string& path, std::int64_t size) const;
  void index();
  [[nodiscard]] std::span<const std::byte> slot(std::size_t i) const;

  recorder::Header header_;
  std::vector<Scene> scenes_;
  std::vector<std::byte> ring_;
  struct Entry {
    std::uint64_t sequence;
    std::size_t slot;
  };
  std::vector<Entry> sound_;  // the valid slots, ordered by sequence number
  std::int64_t damaged_ = 0;
};

}  // namespace ligature::host
