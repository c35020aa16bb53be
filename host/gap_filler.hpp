#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "host/messages.hpp"
#include "host/session_tally.hpp"

namespace ligature::host {

/// Fetches what the network lost from the flight recorder that the firmware names in its status. Works when the
/// firmware runs on this machine (or its recorder's folder is mounted here); elsewhere it finds nothing, and the gaps
/// stay named in the summary.
class GapFiller {
 public:
  using Emit = std::function<void(const ligature_msg::tick_batch_t&)>;

  void note(const ligature_msg::status_t& status);

  /// Emits the missing ticks of every session as batches like the firmware's. A gap is looked for once the
  /// recorder has later ticks: what it does not have by then it will never have, because it writes in order. Cost:
  /// nothing without gaps, one reading of the recorder's file with.
  /// @return how many ticks were fetched.
  std::int64_t fill(const SessionTally& sessions, const Emit& emit);

 private:
  struct Source {
    std::string file;
    std::int64_t searched_below = 0;  // gaps that end before this tick were looked for
  };
  static std::int64_t fill(const Session& session, Source& source, const Emit& emit);

  std::map<std::int64_t, Source> sources_;  // by session
};

}  // namespace ligature::host
