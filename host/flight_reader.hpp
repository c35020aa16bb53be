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

/// Whether a file begins like a flight recorder's; false for one that cannot be read.
[[nodiscard]] bool is_flight_file(const std::string& path);

/// The session that a flight recorder's header names: cheap, nothing else is read. Nothing when it has no sound header.
[[nodiscard]] std::optional<std::int64_t> session_of(const RegularFile& file);

/// Reads a flight recorder file as it is at this moment, also while it is being written. Holds it in memory (0.7 MB for
/// each second of it). A slot whose CRC is wrong is counted and left out; the writer's death leaves at most one.
class FlightReader {
 public:
  /// @throws BadInput when it is not such a file, of another version, or shorter than its header says.
  explicit FlightReader(const std::string& path);
  /// A file that is open already; `path` is what messages call it.
  FlightReader(const RegularFile& file, const std::string& path);

  /// Every sound tick, oldest first.
  void visit(const std::function<void(const ligature_msg::tick_t&)>& take) const;

  [[nodiscard]] std::int64_t session() const { return header_.session; }
  [[nodiscard]] std::int32_t fault() const { return header_.fault; }  ///< it was saved with; 0 = none
  [[nodiscard]] std::size_t ticks() const { return sound_.size(); }
  [[nodiscard]] std::int64_t damaged_slots() const { return damaged_; }
  /// The scene in force at the oldest tick.
  [[nodiscard]] RigFacts facts() const;

  /// A scene with its overrides, and from which tick on it was in force.
  struct Scene {
    std::int64_t first_tick = 0;
    RigFacts facts;
    bool admitted = true;  ///< false: run by --force
  };
  /// In order; the first is the one that the run, or what is known of it, began with.
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
  std::vector<Entry> sound_;  // in order of sequence
  std::int64_t damaged_ = 0;
};

}  // namespace ligature::host
