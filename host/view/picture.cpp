#include "host/view/picture.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

#include "host/view/rig_json.hpp"
#include "host/view/scene_facts.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;

double milliseconds(Picture::Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

}  // namespace

std::int64_t Picture::next_epoch() {
  static std::atomic<std::int64_t> last = 0;
  return ++last;
}

void Picture::take(std::string_view channel, Bytes data, Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  if (channel == kTicksChannel) {
    const auto batch = decode<ligature_msg::tick_batch_t>(data);
    if (!batch) return count_unreadable();
    heard_ = now;
    take_batch(*batch);
  } else if (channel == kThreadChannel) {
    auto thread = decode<ligature_msg::thread_t>(data);
    if (!thread || !is_drawable(*thread)) return count_unreadable();
    thread_ = std::move(*thread);
    ++shape_version_;
  } else if (channel == kStatusChannel) {
    const auto status = decode<ligature_msg::status_t>(data);
    if (!status || status->scene_toml.size() > kLargestStatusText) return count_unreadable();
    take_status(*status);
  } else if (channel == kEventChannel) {
    const auto event = decode<ligature_msg::event_t>(data);
    if (!event) return count_unreadable();
    events_.push(to_json(*event));
  } else if (channel == kOfferChannel) {
    const auto offer = decode<ligature_msg::offer_t>(data);
    if (!offer) return count_unreadable();
    if (json told = to_json(*offer); topics_["offer"].what != told) set_locked("offer", std::move(told));
  }
}

void Picture::take_status(const ligature_msg::status_t& status) {
  set_locked("status", to_json(status));
  if (auto scene = status.scene_file + "\n" + status.scene_toml; scene != scene_) {
    scene_ = std::move(scene);
    set_locked("scene", scene_facts(status.scene_toml, status.scene_file));
  }
}

/// Pages are told the number of unreadable messages when it is 1, 2, 4, 8 ..: so they see at little cost that the
/// number rises.
void Picture::count_unreadable() {
  ++unreadable_;
  if (std::has_single_bit(static_cast<std::uint64_t>(unreadable_))) set_locked("unreadable", unreadable_);
}

void Picture::take_batch(const ligature_msg::tick_batch_t& batch) {
  if (batch.session != session_) {
    if (session_ != -1) start_again_locked();
    session_ = batch.session;
  }
  for (const auto& tick : batch.ticks) {
    if (last_ && tick.tick <= last_->tick) continue;  // duplicate
    const TraceRow row = trace_row(tick);
    rows_.push(row);
    TraceBin done;
    if (bin_maker_.add(row, done)) bins_.push(done);
    last_ = tick;
  }
}

void Picture::start_again_locked() {
  epoch_ = next_epoch();
  rows_.clear();
  bins_.clear();
  bin_maker_.clear();
  events_.clear();
  last_.reset();
}

void Picture::start_again(const std::vector<TraceBin>& history) {
  const std::scoped_lock lock(mutex_);
  start_again_locked();
  session_ = -1;
  for (const auto& bin : history) bins_.push(bin);
}

void Picture::hold(Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  if (heard_) heard_ = now;
}

void Picture::set(const std::string& topic, json what) {
  const std::scoped_lock lock(mutex_);
  set_locked(topic, std::move(what));
}

void Picture::set_locked(const std::string& topic, json what) {
  auto& [version, is] = topics_[topic];
  ++version;
  is = std::move(what);
}

void Picture::add_event(const json& event) {
  const std::scoped_lock lock(mutex_);
  events_.push(event);
}

void Picture::show_beside(const Picture* other) {
  const std::scoped_lock lock(mutex_);
  beside_ = other;
}

std::optional<ligature_msg::thread_t> Picture::newer_shape(std::int64_t& known) const {
  const std::scoped_lock lock(mutex_);
  if (known == shape_version_) return std::nullopt;
  known = shape_version_;
  return thread_;
}

std::int64_t Picture::unreadable() const {
  const std::scoped_lock lock(mutex_);
  return unreadable_;
}

std::vector<std::byte> Picture::frame_for(Place& place, const json& answers, Clock::time_point now) const {
  const std::scoped_lock lock(mutex_);
  FrameWriter frame(++place.frame);
  if (begin_traces(place.traces)) {
    place.topics.clear();
    place.event = events_.begin();
    place.shape = -1;
  }
  json text = changes_since(place);
  if (!answers.empty()) text["answers"] = answers;
  if (!text.empty()) {
    frame.begin(Section::kText);
    frame.add_text(text.dump(-1, ' ', false, json::error_handler_t::replace));
    frame.end();
  }
  write_now(frame, now);
  if (place.shape != shape_version_ && thread_.count > 0) write_shape(frame);
  place.shape = shape_version_;
  write_traces(frame, place.traces, Section::kRows, Section::kBins);
  if (beside_) beside_->write_beside(frame, place.beside);
  return frame.take();
}

bool Picture::begin_traces(TracePlace& place) const {
  if (place.epoch == epoch_) return false;
  place = {epoch_, std::max(rows_.begin(), rows_.end() - kRowsAtFirst), bins_.begin()};
  return true;
}

void Picture::write_beside(FrameWriter& frame, TracePlace& place) const {
  const std::scoped_lock lock(mutex_);
  begin_traces(place);
  frame.begin(Section::kBeside);
  frame.add(static_cast<double>(epoch_));
  frame.end();
  write_traces(frame, place, Section::kBesideRows, Section::kBesideBins);
}

void Picture::write_now(FrameWriter& frame, Clock::time_point now) const {
  frame.begin(Section::kNow);
  frame.add(static_cast<double>(epoch_));
  frame.add(heard_ ? milliseconds(now - *heard_) : -1.0);  // age of the newest ticks, ms; -1: none yet
  if (last_) write_tick(frame, *last_);
  frame.end();
}

void Picture::write_shape(FrameWriter& frame) const {
  frame.begin(Section::kShape);
  frame.add(static_cast<double>(thread_.tick));
  frame.add(static_cast<double>(thread_.radius_m));
  frame.add(static_cast<double>(thread_.grasped_node[0]));
  frame.add(static_cast<double>(thread_.grasped_node[1]));
  for (const auto& p : thread_.p_W_m) frame.add_bytes(p.data(), 3 * sizeof(float));
  for (const auto* values : {&thread_.tension_N, &thread_.turn_rad})
    frame.add_bytes(values->data(), values->size() * sizeof(float));
  frame.end();
}

void Picture::write_traces(FrameWriter& frame, TracePlace& place, Section rows, Section bins) const {
  place.row = std::max(place.row, rows_.begin());
  if (rows_.end() - place.row > kRowsAtFirst)  // the page fell behind: skip to the newest rows; the bins cover the gap
    place.row = rows_.end() - kRowsPerFrame;
  const auto last_row = std::min(rows_.end(), place.row + kRowsPerFrame);
  if (place.row < last_row) {
    frame.begin(rows);
    for (; place.row < last_row; ++place.row) frame.add(rows_[place.row]);
    frame.end();
  }
  place.bin = std::max(place.bin, bins_.begin());
  const auto last_bin = std::min(bins_.end(), place.bin + kBinsPerFrame);
  if (place.bin < last_bin) {
    frame.begin(bins);
    for (; place.bin < last_bin; ++place.bin) frame.add(bins_[place.bin]);
    frame.end();
  }
}

json Picture::changes_since(Place& place) const {
  json text = json::object();
  for (const auto& [name, topic] : topics_) {
    auto& known = place.topics[name];
    if (known != topic.version) text[name] = topic.what;
    known = topic.version;
  }
  place.event = std::max(place.event, events_.begin());
  for (; place.event < events_.end(); ++place.event) text["events"].push_back(events_[place.event]);
  return text;
}

}  // namespace ligature::host::view
