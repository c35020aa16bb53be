#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/flight_reader.hpp"
#include "host/messages.hpp"
#include "host/session_tally.hpp"

namespace ligature::host {

/// Default folders of flight recorder files on this machine: the firmware's own default and the system service's.
[[nodiscard]] std::vector<std::filesystem::path> default_flight_folders();

/// Fetches ticks that the network lost from the flight recorder file that the firmware names in its status. It works
/// when the firmware runs on this machine or its folder is mounted here; otherwise the gaps remain and are reported in
/// the summary.
/// Security: anybody on the network can send a status. Therefore only regular files in the given folders are read, and
/// the session number is taken from the file itself.
class GapFiller {
 public:
  using Emit = std::function<void(const ligature_msg::tick_batch_t&)>;
  enum class Ends { kOpen, kClosed };
  static constexpr std::size_t kMostFiles = 16;

  explicit GapFiller(const std::vector<std::filesystem::path>& folders);

  void note(const ligature_msg::status_t& status);

  /// Emits the missing ticks of every session in batches like the firmware's. A gap is looked up once, when the flight
  /// recorder already holds later ticks: the recorder writes in order, so a tick that is absent then never comes. Cost:
  /// nothing without gaps, else one reading of the recorder's file.
  /// @param ends kClosed: also emits the ticks after a session's last received one (the last batch of a killed
  /// firmware).
  /// @return number of ticks fetched.
  std::int64_t fill(const SessionTally& sessions, const Emit& emit, Ends ends = Ends::kOpen);

  /// Whether the last tick of this session is known, because fill() with kClosed has read the session's flight recorder
  /// file.
  [[nodiscard]] bool knows_end_of(std::int64_t session) const { return ended_.contains(session); }
  /// A flight recorder file that a status named outside the allowed folders; empty when there was none.
  [[nodiscard]] const std::string& outside() const { return outside_; }

 private:
  [[nodiscard]] std::optional<RegularFile> open(const std::string& path) const;
  std::int64_t fill_from(const std::string& path, const SessionTally& sessions, const Emit& emit, Ends ends);
  std::int64_t fill_from(const FlightReader& recorder, const Session& session, std::vector<TickRange> holes,
                         const Emit& emit);

  std::vector<std::filesystem::path> folders_;
  std::set<std::string> files_;  // named by a status, and inside an allowed folder
  // session id -> tick; gaps of the session that end before this tick have been searched for already
  std::map<std::int64_t, std::int64_t> searched_below_;
  std::set<std::int64_t> ended_;
  std::string outside_;
};

}  // namespace ligature::host
