#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "host/gap_filler.hpp"
#include "host/lcm_link.hpp"
#include "host/live_tally.hpp"
#include "host/log_writer.hpp"

namespace ligature::host {

/// What goes into the log: everything heard, and what the flight recorder has of what was not.
class Recording {
 public:
  Recording(LogWriter& log, LiveTally& tally, const std::vector<std::filesystem::path>& flight_folders)
      : log_(log), tally_(tally), filler_(flight_folders) {}

  void take(const Message& message);
  /// Fetches what is missing between the ticks that came.
  void fill() { fetch(GapFiller::Ends::kOpen); }
  /// The last fetching: the ends of runs, too.
  /// @param is_quiet nobody sends any more; else the run that was heard last goes on, and has no end to look for.
  void finish(bool is_quiet);

  /// Lines about what was recorded, lost and fetched; complete after finish().
  [[nodiscard]] std::string summary() const;

 private:
  void fetch(GapFiller::Ends ends);

  LogWriter& log_;
  LiveTally& tally_;
  GapFiller filler_;
  std::vector<std::byte> bytes_;
  std::vector<std::vector<std::byte>> waiting_;
  std::vector<std::int64_t> open_ends_;  // sessions of which more ticks may have been
  std::int64_t filled_ = 0;
};

}  // namespace ligature::host
