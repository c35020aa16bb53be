#include "host/view/log_survey.hpp"

#include <algorithm>

#include "host/messages.hpp"
#include "host/text.hpp"
#include "host/thread_knot.hpp"
#include "host/view/picture.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {

LogSurvey::LogSurvey(const LogMap& map) : map_(map), thread_([this](const std::stop_token& stop) { go(stop); }) {}

void LogSurvey::go(const std::stop_token& stop) {
  std::vector<std::byte> payload;
  const auto& entries = map_.entries();
  for (std::size_t i = 0; i < entries.size() && !stop.stop_requested(); ++i) {
    const auto& entry = entries[i];
    const double t_s = map_.time_s(entry.time_us);
    const bool is_wanted = entry.channel == LogMap::Channel::kTicks || entry.channel == LogMap::Channel::kEvent ||
                           (entry.channel == LogMap::Channel::kStatus && !has_period_) ||
                           (entry.channel == LogMap::Channel::kThread && t_s >= knot_due_s_);
    if (!is_wanted || !map_.read(entry, payload)) continue;
    if (entry.channel == LogMap::Channel::kTicks) take_batch(t_s, payload);
    if (entry.channel == LogMap::Channel::kStatus) take_status(payload);
    if (entry.channel == LogMap::Channel::kEvent) take_event(t_s, payload);
    if (entry.channel == LogMap::Channel::kThread) take_shape(t_s, payload);
    progress_ = static_cast<double>(i) / static_cast<double>(entries.size());
  }
  progress_ = 1.0;
}

void LogSurvey::take_status(const std::vector<std::byte>& payload) {
  const auto status = decode<ligature_msg::status_t>(payload);
  if (!status || !(status->period_s > 0.0)) return;
  has_period_ = true;
  const std::scoped_lock lock(mutex_);
  landmarks_.period_s = status->period_s;
}

void LogSurvey::take_batch(double t_s, const std::vector<std::byte>& payload) {
  const auto batch = decode<ligature_msg::tick_batch_t>(payload);
  if (!batch) return;
  if (batch->session != session_) bin_maker_.clear();
  session_ = batch->session;
  const std::scoped_lock lock(mutex_);
  for (const auto& tick : batch->ticks) {
    const TraceRow row = trace_row(tick);
    // A batch arrives after its last tick, so the times of its other ticks are counted back from there. In a short
    // recording the ticks of one batch belong to several columns of the overview.
    const double tick_s = t_s - static_cast<double>(batch->ticks.back().tick - tick.tick) * landmarks_.period_s;
    const double share = map_.duration_s() > 0.0 ? std::clamp(tick_s / map_.duration_s(), 0.0, 1.0) : 0.0;
    const auto column = std::min(kOverview - 1, static_cast<std::size_t>(share * static_cast<double>(kOverview)));
    if (!landmarks_.first_tick) landmarks_.first_tick = tick.tick, landmarks_.first_tick_s = t_s;
    if (!landmarks_.first_grasp && (tick.grasped_node[0] >= 0 || tick.grasped_node[1] >= 0))
      landmarks_.first_grasp = tick.tick;
    overview_[0][column] = std::max(overview_[0][column], static_cast<float>(row[kLeft]));
    overview_[1][column] = std::max(overview_[1][column], static_cast<float>(row[kRight]));
    TraceBin done;
    if (bin_maker_.add(row, done) && bins_.size() < kMostBins) bins_.push_back({t_s, session_, done});
  }
}

void LogSurvey::take_event(double t_s, const std::vector<std::byte>& payload) {
  if (const auto event = decode<ligature_msg::event_t>(payload)) add_mark(t_s, event->kind, event->hand, event->text);
}

void LogSurvey::take_shape(double t_s, const std::vector<std::byte>& payload) {
  const auto thread = decode<ligature_msg::thread_t>(payload);
  if (!thread || !is_drawable(*thread)) return;
  knot_due_s_ = t_s + kKnotPeriod_s;
  const auto knot = name_knot(*thread);
  const std::string name = knot.type + " " + knot.handedness;
  if (name != knot_) add_mark(t_s, kKnotEvent, -1, "knot " + name);
  knot_ = name;
}

void LogSurvey::add_mark(double t_s, int kind, int hand, const std::string& text) {
  const std::scoped_lock lock(mutex_);
  if (marks_.size() < kMostMarks)
    marks_.push_back({{"t_s", t_s}, {"kind", kind}, {"hand", hand}, {"text", shortened(text, 200)}});
}

LogSurvey::Landmarks LogSurvey::landmarks() const {
  const std::scoped_lock lock(mutex_);
  return landmarks_;
}

nlohmann::json LogSurvey::marks() const {
  const std::scoped_lock lock(mutex_);
  return {{"marks", marks_}, {"left_N", overview_[0]}, {"right_N", overview_[1]}};
}

std::vector<TraceBin> LogSurvey::history(double t_s) const {
  const std::scoped_lock lock(mutex_);
  const auto end = std::ranges::upper_bound(bins_, t_s, {}, &TimedBin::t_s);
  std::vector<TraceBin> found;
  for (auto it = end; it != bins_.begin() && found.size() < Picture::kBins; --it) {
    if (std::prev(it)->session != std::prev(end)->session) break;
    found.push_back(std::prev(it)->bin);
  }
  std::ranges::reverse(found);
  return found;
}

}  // namespace ligature::host::view
