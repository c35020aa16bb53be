#include "host/recording.hpp"

#include "host/log_format.hpp"
#include "host/text.hpp"
#include "host/wall_clock.hpp"

namespace ligature::host {

void Recording::take(const Message& message) {
  // the checksum event of a log that is being played back; this log gets its own checksums
  if (message.channel == kCheckChannel) return;
  if (!LogWriter::takes(message.channel, message.data)) return tally_.refuse();
  log_.write(message.received_us, message.channel, message.data);
  tally_.add(message.channel, message.data);
  if (message.channel != kStatusChannel) return;
  if (const auto status = decode<ligature_msg::status_t>(message.data)) filler_.note(*status);
}

void Recording::fetch(GapFiller::Ends ends) {
  const auto emit = [this](const ligature_msg::tick_batch_t& batch) {
    encode(batch, bytes_);
    log_.write(now_us(), kTicksChannel, bytes_);
    waiting_.push_back(bytes_);
  };
  filled_ += filler_.fill(tally_.sessions(), emit, ends);
  // the fetched ticks are counted only now, because fill() reads the tally's list of gaps
  for (const auto& bytes : waiting_) tally_.add(kTicksChannel, bytes);
  waiting_.clear();
}

void Recording::finish(bool is_quiet) {
  const auto running = is_quiet ? std::nullopt : tally_.newest_session();
  fetch(GapFiller::Ends::kClosed);
  for (const Session& session : tally_.sessions().sessions())
    if (session.id != running && !session.ticks.is_empty() && !filler_.knows_end_of(session.id))
      open_ends_.push_back(session.id);
}

std::string Recording::summary() const {
  std::string lines = tally_.summary(open_ends_);
  if (filled_ > 0) lines += text("%lld of the ticks came from the flight recorder\n", static_cast<long long>(filled_));
  if (!filler_.outside().empty() && (tally_.sessions().missing() > 0 || !open_ends_.empty()))
    lines += "flight recorder " + std::string(shown(filler_.outside())) +
             " was not read: it lies in none of the folders that may be; --flight-folder FOLDER allows another\n";
  return lines;
}

}  // namespace ligature::host
