#include "host/gap_filler.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "host/errors.hpp"

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

namespace fs = std::filesystem;

std::vector<fs::path> default_flight_folders() {
  std::vector<fs::path> folders{"/var/lib/ligature"};
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state != nullptr && *state == '/')
    folders.push_back(fs::path(state) / "ligature");
  else if (home != nullptr && *home == '/')
    folders.push_back(fs::path(home) / ".local/state/ligature");
  return folders;
}

GapFiller::GapFiller(const std::vector<fs::path>& folders) {
  for (const auto& folder : folders) {
    const auto normal = fs::absolute(folder).lexically_normal();
    folders_.push_back(normal.has_filename() ? normal : normal.parent_path());  // removes a trailing slash
  }
}

/// Remembers the flight recorder file that a status names, if it is in an allowed folder. Only the text of the path is
/// checked: a forged status could name a folder on a network file system, and accessing it could block for ever.
void GapFiller::note(const ligature_msg::status_t& status) {
  if (status.recorder_file.empty()) return;
  const fs::path file = fs::path(status.recorder_file).lexically_normal();
  if (std::ranges::find(folders_, file.parent_path()) == folders_.end()) {
    if (outside_.empty()) outside_ = status.recorder_file;
  } else if (files_.size() < kMostFiles) {
    files_.insert(file.string());
  }
}

std::int64_t GapFiller::fill(const SessionTally& sessions, const Emit& emit, Ends ends) {
  if (ends == Ends::kOpen && sessions.missing() == 0) return 0;
  std::int64_t filled = 0;
  const auto files = files_;
  for (const auto& file : files) {
    filled += fill_from(file, sessions, emit, ends);
    filled += fill_from(file + ".previous", sessions, emit, ends);  // a restarted firmware renames its old file so
  }
  return filled;
}

std::optional<RegularFile> GapFiller::open(const std::string& path) const try {
  const fs::path file(path);
  return RegularFile(file.parent_path(), file.filename());
} catch (const BadInput&) {  // not on this machine, or not readable: the gaps remain and are reported
  return std::nullopt;
}

std::int64_t GapFiller::fill_from(const std::string& path, const SessionTally& sessions, const Emit& emit, Ends ends) {
  const auto file = open(path);
  const auto id = file ? session_of(*file) : std::nullopt;
  if (!id) {
    files_.erase(path);  // may come from a forged status; the firmware names its own file again within 0.1 s
    return 0;
  }
  const auto session = std::ranges::find(sessions.sessions(), *id, &Session::id);
  if (session == sessions.sessions().end() || session->ticks.is_empty()) return 0;
  auto holes = session->ticks.missing_ranges();
  std::erase_if(holes, [&](const TickRange& hole) { return hole.last < searched_below_[*id]; });
  if (ends == Ends::kClosed) holes.push_back({session->ticks.last() + 1, std::numeric_limits<std::int64_t>::max() - 1});
  if (holes.empty()) return 0;
  try {
    const auto filled = fill_from(FlightReader(*file, path), *session, std::move(holes), emit);
    if (ends == Ends::kClosed) ended_.insert(*id);
    return filled;
  } catch (const BadInput&) {  // damaged file
    return 0;
  }
}

std::int64_t GapFiller::fill_from(const FlightReader& recorder, const Session& session, std::vector<TickRange> holes,
                                  const Emit& emit) {
  std::int64_t filled = 0, newest = -1;
  Batcher batcher(session, emit);
  auto hole = holes.begin();
  recorder.visit([&](const ligature_msg::tick_t& tick) {
    newest = tick.tick;
    while (hole != holes.end() && hole->last < tick.tick) ++hole;
    if (hole == holes.end() || tick.tick < hole->first) return;
    batcher.add(tick);
    ++filled;
  });
  batcher.flush();
  searched_below_[session.id] = std::min(holes.back().last, newest) + 1;
  return filled;
}

}  // namespace ligature::host
