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

/// Where flight recorders of this machine are written unless ligature-firmware was told otherwise: its own default and
/// the service's folder.
[[nodiscard]] std::vector<std::filesystem::path> default_flight_folders();

/// Fetches what the network lost from the flight recorder that the firmware names in its status. Works when the
/// firmware runs on this machine (or its recorder's folder is mounted here); elsewhere it finds nothing, and the gaps
/// stay named in the summary.
/// Anybody on the network can send a status, so its word is only a hint: regular files of the given folders are read
/// and nothing else, and which session a file holds is what the file itself says.
class GapFiller {
 public:
  using Emit = std::function<void(const ligature_msg::tick_batch_t&)>;
  enum class Ends { kOpen, kClosed };
  static constexpr std::size_t kMostFiles = 16;

  explicit GapFiller(const std::vector<std::filesystem::path>& folders);

  void note(const ligature_msg::status_t& status);

  /// Emits the missing ticks of every session as batches like the firmware's. A gap is looked for once the
  /// recorder has later ticks: what it does not have by then it will never have, because it writes in order. Cost:
  /// nothing without gaps, one reading of the recorder's file with.
  /// @param ends closed: what follows a session's last tick is missing, too (a killed firmware's last batch).
  /// @return how many ticks were fetched.
  std::int64_t fill(const SessionTally& sessions, const Emit& emit, Ends ends = Ends::kOpen);

  /// Whether a flight recorder was read to its end for this session with `ends` closed.
  [[nodiscard]] bool knows_end_of(std::int64_t session) const { return ended_.contains(session); }
  /// A flight recorder that a status named and that lies in none of the folders; empty when there was none.
  [[nodiscard]] const std::string& outside() const { return outside_; }

 private:
  [[nodiscard]] std::optional<RegularFile> open(const std::string& path) const;
  std::int64_t fill_from(const std::string& path, const SessionTally& sessions, const Emit& emit, Ends ends);
  std::int64_t fill_from(const FlightReader& recorder, const Session& session, std::vector<TickRange> holes,
                         const Emit& emit);

  std::vector<std::filesystem::path> folders_;
  std::set<std::string> files_;                          // that a status named, and that lie in a folder of ours
  std::map<std::int64_t, std::int64_t> searched_below_;  // by session: gaps that end before this tick were looked for
  std::set<std::int64_t> ended_;
  std::string outside_;
};

}  // namespace ligature::host
