#include "firmware/telemetry/flight_recorder.hpp"

#include <algorithm>
#include <utility>

namespace ligature::telemetry {
namespace {

constexpr std::chrono::milliseconds kWritePeriod(5);
constexpr std::chrono::milliseconds kSyncPeriod(500);
constexpr std::chrono::milliseconds kScenePatience(100);  // longest wait for scene_changed()
constexpr std::size_t kBatch = 256;

}  // namespace

std::variant<std::unique_ptr<FlightRecorder>, std::string> FlightRecorder::open(const std::string& path,
                                                                                const FlightFacts& facts,
                                                                                std::int64_t slots) {
  const auto header = header_of(facts, slots);
  auto disk = FileDisk::make(path, file_bytes(header));
  if (auto* why = std::get_if<std::string>(&disk)) return std::move(*why);
  return std::make_unique<FlightRecorder>(std::move(std::get<0>(disk)), path, header);
}

FlightRecorder::FlightRecorder(std::unique_ptr<Disk> disk, const std::string& path, const recorder::Header& header,
                               std::size_t room)
    : disk_(std::move(disk)), slots_(path, *disk_, header), inlet_(room) {
  batch_.reserve(kBatch);
  writer_ = std::thread([this] { write_down(); });
  syncer_ = std::thread([this] { keep_disk_up(); });
}

void FlightRecorder::finish() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  writer_.join();
  syncer_.join();
  disk_->sync();
}

/// Sleeps for at most `at_most`. @return true if the run is over.
bool FlightRecorder::rest(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  return wake_.wait_for(lock, at_most, [this] { return ending_; });
}

void FlightRecorder::write_down() {
  for (bool last = false; !last;) {
    last = rest(kWritePeriod);
    take_all();
  }
  // Records dropped at the very end are reported here, because no later tick reveals the gap.
  const auto behind = static_cast<std::int64_t>(inlet_.dropped()) - holes_;
  if (behind > 0) lose(behind, next_tick_, next_tick_ + behind - 1, "the disk stood still for too long");
}

void FlightRecorder::expect_scene(bool expected) {
  {
    const std::lock_guard lock(mutex_);
    scene_expected_ = expected;
  }
  wake_.notify_all();
}

void FlightRecorder::scene_changed(FlightScene scene) {
  const std::lock_guard lock(mutex_);
  scenes_.push_back(std::move(scene));
}

void FlightRecorder::take_scenes() {
  std::vector<FlightScene> come;
  {
    const std::lock_guard lock(mutex_);
    come.swap(scenes_);
  }
  for (const auto& scene : come) slots_.add(scene);
}

void FlightRecorder::take_all() {
  take_scenes();
  for (;;) {
    batch_.clear();
    bool faulted = false;
    for (rt::TickRecord r; !faulted && batch_.size() < kBatch && inlet_.pop(r);) {
      faulted = (r.flags & rt::kPeriodLost) == 0 && std::exchange(fault_, r.fault) != r.fault && r.fault != 0;
      batch_.push_back(r);
    }
    if (batch_.empty()) return;
    look_for_holes();
    if (const auto refused = slots_.append(batch_); refused > 0) {
      lose(static_cast<std::int64_t>(refused), batch_.front().tick, batch_.back().tick, "the disk does not take them");
    }
    if (faulted) save(batch_.back());
  }
}

void FlightRecorder::look_for_holes() {
  for (const auto& r : batch_) {
    if (const auto hole = r.tick - next_tick_; hole > 0) {
      holes_ += hole;
      lose(hole, next_tick_, r.tick - 1, "the disk stood still for too long");
    }
    next_tick_ = r.tick + 1;
  }
}

void FlightRecorder::save(const rt::TickRecord& faulted) {
  {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, kScenePatience, [this] { return !scene_expected_; });
  }
  take_scenes();
  const std::string file = slots_.save_last(kTicksPerFault, faulted.fault);
  note({faulted.tick, faulted.fault,
        "the ticks before fault " + std::to_string(faulted.fault) +
            (file.empty() ? " could not be saved" : " are saved: " + file)});
}

void FlightRecorder::lose(std::int64_t count, std::int64_t first, std::int64_t last, const char* why) {
  missing_.fetch_add(count, std::memory_order_relaxed);
  if (++notes_of_loss_ > kMaxNotesOfLoss) return;
  note({last, 0,
        "flight recorder: " + std::to_string(count) + " of the ticks " + std::to_string(first) + ".." +
            std::to_string(last) + " are missing: " + why});
}

void FlightRecorder::note(FlightNote what) {
  const std::lock_guard lock(mutex_);
  notes_.push_back(std::move(what));
}

std::vector<FlightNote> FlightRecorder::take_notes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(notes_, {});
}

void FlightRecorder::keep_disk_up() {
  using Clock = std::chrono::steady_clock;
  while (!rest(kSyncPeriod)) {
    const auto began = Clock::now();
    disk_->sync();
    const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began).count();
    slowest_sync_ms_.store(std::max<std::int64_t>(slowest_sync().count(), took), std::memory_order_relaxed);
  }
}

}  // namespace ligature::telemetry
