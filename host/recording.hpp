#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "host/gap_filler.hpp"
#include "host/lcm_link.hpp"
#include "host/live_tally.hpp"
#include "host/log_writer.hpp"

namespace ligature::host {

/// Writes the log: all received messages, and missing ticks fetched from the flight recorder.
class Recording {
 public:
  Recording(LogWriter& log, LiveTally& tally, const std::vector<std::filesystem::path>& flight_folders)
      : log_(log), tally_(tally), filler_(flight_folders) {}

  void take(const Message& message);
  /// Adds ticks that are missing between received ones, from the flight recorder.
  void fill() { fetch(GapFiller::Ends::kOpen); }
  /// Adds missing ticks from the flight recorder for the last time, also those after each session's last received tick.
  /// @param is_quiet true: nothing is being sent any more. false: the newest session still runs, so that it has no end
  /// is not reported.
  void finish(bool is_quiet);

  /// Lines that say what was recorded, lost and fetched; complete after finish().
  [[nodiscard]] std::string summary() const;

 private:
  void fetch(GapFiller::Ends ends);

  LogWriter& log_;
  LiveTally& tally_;
  GapFiller filler_;
  std::vector<std::byte> bytes_;
  std::vector<std::vector<std::byte>> waiting_;
  std::vector<std::int64_t> open_ends_;  // sessions that may have had more ticks after the last recorded one
  std::int64_t filled_ = 0;
};

}  // namespace ligature::host
