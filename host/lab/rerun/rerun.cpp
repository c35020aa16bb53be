#include "host/lab/rerun/rerun.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "firmware/platform/realtime.hpp"
#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/gap_counter.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/rerun/thread_player.hpp"
#include "host/log_reader.hpp"
#include "host/messages.hpp"
#include "host/tick_order.hpp"

namespace ligature::lab {
namespace {

using ligature_msg::thread_t;
using ligature_msg::tick_t;

/// Limit on shapes or ticks that wait for their counterpart: the two come on different channels, in either order.
constexpr std::size_t kWaiting = 1024;

class Play {
 public:
  Play(const RerunOptions& options, const RecordedRun& run)
      : run_(run),
        player_(scenes_of(options.log, run, options.overrides), options.cuts),
        outcome_{Differences(run.period_s), run.ticks, run.period_s, 0, {}, 0, false} {
    if (options.output) output_ = options.output(run);
  }

  void take(const host::LogEvent& event) {
    if (output_) output_->begin(event);
    if (event.channel == host::kTicksChannel) {
      if (const auto batch = host::decode<ligature_msg::tick_batch_t>(event.data)) return take(*batch);
    } else if (event.channel == host::kThreadChannel) {
      if (auto shape = host::decode<thread_t>(event.data); shape && is_ours_) return take(std::move(*shape));
    } else if (event.channel == host::kStatusChannel) {
      const auto status = host::decode<ligature_msg::status_t>(event.data);
      if (status && status->session == run_.session && output_) output_->add(*status);
    } else if (event.channel == host::kEventChannel && is_ours_ && output_ &&
               host::is_readable(event.channel, event.data)) {
      output_->copy(event);
    }
  }

  RerunOutcome finish(bool interrupted) {
    order_.flush([this](const tick_t& t) { play(t); });
    if (output_) output_->end_batch(like_), output_->close();
    outcome_.interrupted = interrupted;
    outcome_.shapes_alone += static_cast<std::int64_t>(recorded_.size());
    outcome_.why_unknown = outcome_.unknown_ticks > 0 ? player_.why_unknown() : "";
    return std::move(outcome_);
  }

 private:
  void take(const ligature_msg::tick_batch_t& batch) {
    is_ours_ = batch.session == run_.session;
    if (!is_ours_) return;
    like_ = batch;
    like_.ticks.clear();
    for (const auto& tick : batch.ticks)
      if (seen_.add(tick.tick)) order_.add(tick, [this](const tick_t& t) { play(t); });
    if (output_) output_->end_batch(like_);
  }

  void play(const tick_t& tick) {
    const auto again = player_.take(tick);
    if (again) {
      outcome_.differences.add(tick, *again, player_.cost_us());
      const tick_t felt = with_device_forces(tick, *again);
      if (output_) output_->add(tick, felt, player_.cost_us());
    } else {
      ++outcome_.unknown_ticks;
      if (output_) output_->add_unknown(tick);
    }
    for (auto& shape : player_.take_shapes()) {
      if (const auto waits = recorded_.find(shape.tick); waits != recorded_.end()) {
        compare(waits->second, shape);
        recorded_.erase(waits);
      } else {
        played_.emplace(shape.tick, std::move(shape));
        if (played_.size() > kWaiting) played_.erase(played_.begin());
      }
    }
  }

  void take(thread_t shape) {
    if (shape.tick == compared_tick_) return;  // duplicate: `lab tie` writes its last shape twice
    if (const auto at = played_.find(shape.tick); at != played_.end()) {
      compare(shape, at->second);
      played_.erase(at);
      return;
    }
    recorded_.insert_or_assign(shape.tick, std::move(shape));
    if (recorded_.size() > kWaiting) recorded_.erase(recorded_.begin()), ++outcome_.shapes_alone;
  }

  void compare(const thread_t& recorded, const thread_t& again) {
    compared_tick_ = recorded.tick;
    outcome_.differences.add(recorded, again);
    if (output_) output_->add(recorded, again);
  }

  /// Device forces of the rerun. The hands' motion is the recorded one, so these forces are the recorded ones plus the
  /// change of the thread's force. The change acts one period later, because the control law uses the grasp of the
  /// period before.
  tick_t with_device_forces(const tick_t& recorded, tick_t again) {
    const double scale = player_.force_scale(), most_N = player_.max_force_N();
    for (std::size_t h = 0; h < 2; ++h) {
      double size_N2 = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        again.f_wish_N[h][k] += scale * more_N_[h][k];
        again.f_device_N[h][k] += recorded.gain[h] * scale * more_N_[h][k];
        size_N2 += again.f_device_N[h][k] * again.f_device_N[h][k];
        const double more_N = again.f_world_N[h][k] - recorded.f_world_N[h][k];
        more_N_[h][k] = std::isfinite(more_N) ? more_N : 0.0;
      }
      if (size_N2 <= most_N * most_N || std::ranges::equal(again.f_device_N[h], recorded.f_device_N[h])) continue;
      for (double& f : again.f_device_N[h]) f *= most_N / std::sqrt(size_N2);
    }
    return again;
  }

  const RecordedRun& run_;
  ThreadPlayer player_;
  RerunOutcome outcome_;
  std::unique_ptr<RerunOutput> output_;
  host::GapCounter seen_;
  host::TickOrder order_;
  ligature_msg::tick_batch_t like_{};
  std::map<std::int64_t, thread_t> recorded_, played_;  // by tick: shapes not yet compared
  std::array<std::array<double, 3>, 2> more_N_{};       // f_world of the last tick: recomputed minus recorded
  std::int64_t compared_tick_ = -1;
  bool is_ours_ = false;
};

}  // namespace

RerunOutcome rerun(const RerunOptions& options) {
  platform::flush_denormals();  // the firmware runs in this floating-point mode, too
  const RecordedRun run = survey(options.log, options.session);
  Play play(options, run);
  console::Progress progress("rerun");
  host::LogReader log(options.log);
  try {
    while (const host::LogEvent* event = log.next()) {
      if (!options.go_on()) return play.finish(true);
      play.take(*event);
      progress.show(log.offset(), log.size());
    }
  } catch (const host::RunFailed&) {
    if (!console::stop_requested()) throw;
    return play.finish(true);
  }
  return play.finish(false);
}

}  // namespace ligature::lab
