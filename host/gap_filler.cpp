#include "host/gap_filler.hpp"

#include <algorithm>

#include "host/errors.hpp"
#include "host/flight_reader.hpp"

namespace ligature::host {
namespace {

constexpr std::size_t kTicksPerBatch = 20;

/// Collects ticks into batches.
class Batcher {
 public:
  Batcher(const Session& session, const GapFiller::Emit& emit) : emit_(emit) {
    batch_.session = session.id;
    batch_.utime = session.id;
    batch_.ring_dropped = session.ring_dropped;
  }
  void add(const ligature_msg::tick_t& tick) {
    batch_.ticks.push_back(tick);
    if (batch_.ticks.size() == kTicksPerBatch) flush();
  }
  void flush() {
    if (batch_.ticks.empty()) return;
    batch_.count = static_cast<std::int32_t>(batch_.ticks.size());
    emit_(batch_);
    batch_.ticks.clear();
  }

 private:
  const GapFiller::Emit& emit_;
  ligature_msg::tick_batch_t batch_{};
};

}  // namespace

void GapFiller::note(const ligature_msg::status_t& status) {
  if (status.recorder_file.empty() || sources_.size() >= SessionTally::kMaxSessions) return;
  sources_.try_emplace(status.session, Source{status.recorder_file, 0});
}

std::int64_t GapFiller::fill(const SessionTally& sessions, const Emit& emit) {
  std::int64_t filled = 0;
  for (const Session& session : sessions.sessions()) {
    const auto source = sources_.find(session.id);
    if (source != sources_.end() && session.ticks.missing() > 0) filled += fill(session, source->second, emit);
  }
  return filled;
}

std::int64_t GapFiller::fill(const Session& session, Source& source, const Emit& emit) {
  auto holes = session.ticks.missing_ranges();
  std::erase_if(holes, [&](const TickRange& hole) { return hole.last < source.searched_below; });
  if (holes.empty()) return 0;
  source.searched_below = holes.back().last + 1;
  std::int64_t filled = 0;
  try {
    const FlightReader recorder(source.file);
    if (recorder.session() != session.id) return 0;  // a later run has taken the file
    Batcher batcher(session, emit);
    auto hole = holes.begin();
    std::int64_t newest = -1;
    recorder.visit([&](const ligature_msg::tick_t& tick) {
      newest = tick.tick;
      while (hole != holes.end() && hole->last < tick.tick) ++hole;
      if (hole == holes.end() || tick.tick < hole->first) return;
      batcher.add(tick);
      ++filled;
    });
    batcher.flush();
    source.searched_below = std::min(source.searched_below, newest + 1);
  } catch (const BadInput&) {  // not on this machine, or not readable: the gaps stay gaps, and are named
  }
  return filled;
}

}  // namespace ligature::host
