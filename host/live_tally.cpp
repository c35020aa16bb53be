#include "host/live_tally.hpp"

#include <algorithm>

#include "host/log_format.hpp"
#include "host/names.hpp"
#include "host/text.hpp"
#include "host/tick_statistics.hpp"

namespace ligature::host {
namespace {

/// A text such as "lost in session 1: ticks 100..119, 400 (21; 0 of them dropped inside the firmware)"; empty when no
/// tick is missing.
std::string describe_losses(const Session& session, int number, std::size_t max_ranges) {
  std::string line;
  if (session.ticks.first() > 1)  // ticks before the recorder was started do not count as lost, but they are absent
    line = text("session %d was joined at tick %lld\n", number, static_cast<long long>(session.ticks.first()));
  if (session.ticks.missing() == 0) return line;
  line += text("lost in session %d: ticks ", number);
  const auto holes = session.ticks.missing_ranges();
  for (std::size_t i = 0; i < holes.size() && i < max_ranges; ++i) {
    line += text("%s%lld", i ? ", " : "", static_cast<long long>(holes[i].first));
    if (holes[i].size() > 1) line += text("..%lld", static_cast<long long>(holes[i].last));
  }
  if (holes.size() > max_ranges) line += text(" and %zu more holes", holes.size() - max_ranges);
  return line + text(" (%lld in all; %lld dropped inside the firmware)\n",
                     static_cast<long long>(session.ticks.missing()), static_cast<long long>(session.ring_dropped));
}

}  // namespace

void LiveTally::add(std::string_view channel, Bytes message) {
  ++messages_;
  if (channel == kTicksChannel) {
    const auto batch = decode<ligature_msg::tick_batch_t>(message);
    batch ? add(*batch) : void(++unreadable_);
  } else if (!is_readable(channel, message)) {
    ++unreadable_;
  } else if (channel == kThreadChannel) {
    ++shapes_;
  }
}

void LiveTally::add(const ligature_msg::tick_batch_t& batch) {
  const int index = sessions_.find_or_add(batch.session);
  if (index < 0) return sessions_.leave_out(batch.ticks.size());
  Session& session = sessions_[index];
  session.ring_dropped = batch.ring_dropped;
  for (const auto& tick : batch.ticks) sessions_.add(index, tick.tick);
  if (batch.ticks.empty()) return;
  newest_session_ = batch.session;
  const auto& newest = batch.ticks.back();
  state_ = newest.state;
  fault_ = newest.fault;
  for (std::size_t hand = 0; hand < 2; ++hand) force_N_[hand] = magnitude(newest.f_device_N[hand]);
}

std::string LiveTally::progress_line(double elapsed_s, double ticks_per_s) const {
  std::string line =
      text("%7.1f s  %lld ticks  %.0f/s  %lld lost", elapsed_s, static_cast<long long>(sessions_.received()),
           ticks_per_s, static_cast<long long>(sessions_.missing()));
  if (sessions_.left_out() > 0) line += text("  %lld not counted", static_cast<long long>(sessions_.left_out()));
  if (sessions_.restarts() > 0)
    line += sessions_.are_interleaved() ? text("  %zu FIRMWARES AT ONCE", sessions_.sessions().size())
                                        : text("  %zu restarts", sessions_.restarts());
  if (sessions_.received() == 0) return line + "  waiting for the firmware";
  line += text("  %-7s left %.2f N  right %.2f N", std::string(state_name(state_)).c_str(), force_N_[0], force_N_[1]);
  if (fault_ != 0) line += text("  FAULT %d", fault_);
  return line;
}

std::string LiveTally::summary(std::span<const std::int64_t> open_ends, std::size_t max_ranges) const {
  const auto received = sessions_.received(), missing = sessions_.missing();
  const bool is_whole = open_ends.empty() && sessions_.left_out() == 0;
  std::string lines =
      text(is_whole ? "recorded %lld of %lld ticks, %lld lost"
                    : "recorded %lld of at least %lld ticks, %lld known to be lost",
           static_cast<long long>(received), static_cast<long long>(received) + static_cast<long long>(missing),
           static_cast<long long>(missing));
  lines +=
      text("; %lld shapes, %lld messages in all\n", static_cast<long long>(shapes_), static_cast<long long>(messages_));
  if (sessions_.restarts() > 0)
    lines +=
        text("sessions: %zu (%s)\n", sessions_.sessions().size(),
             sessions_.are_interleaved() ? "several firmwares sent at the same time" : "the firmware was restarted");
  if (sessions_.duplicates() > 0)
    lines += text("duplicates: %lld ticks came twice\n", static_cast<long long>(sessions_.duplicates()));
  if (unreadable_ > 0)
    lines += text("unreadable: %lld messages, kept as they came\n", static_cast<long long>(unreadable_));
  if (refused_ > 0)
    lines += text("refused: %lld messages of more than %d MB\n", static_cast<long long>(refused_), kLargestData >> 20);
  if (sessions_.left_out() > 0)
    lines += text("not counted: %lld ticks of further sessions, all kept; more than %zu are forged or garbage\n",
                  static_cast<long long>(sessions_.left_out()), SessionTally::kMaxSessions);
  int number = 0;
  std::size_t named_ends = 0;
  for (const auto& session : sessions_.sessions()) {
    lines += describe_losses(session, ++number, max_ranges);
    if (std::ranges::find(open_ends, session.id) != open_ends.end() && named_ends++ < max_ranges)
      lines += text("session %d ended after tick %lld or later: no flight recorder of it was found\n", number,
                    static_cast<long long>(session.ticks.last()));
  }
  return lines;
}

}  // namespace ligature::host
