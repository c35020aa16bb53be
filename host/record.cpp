#include "host/record.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include "host/atomic_file.hpp"
#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/gap_filler.hpp"
#include "host/live_tally.hpp"
#include "host/log_writer.hpp"
#include "host/wall_clock.hpp"

namespace ligature::host {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr auto kTerminalEvery = milliseconds(250);  // progress on a terminal
constexpr auto kPlainEvery = milliseconds(5000);    // and in a log file
constexpr auto kFillEvery = milliseconds(1000);     // gaps, from the flight recorder
constexpr auto kLongestDrain = milliseconds(300);   // for messages still on their way after the stop
constexpr int kQuiet_ms = 100;                      // nothing came for that long: nothing is on its way

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// One line, rewritten in place on a terminal, a line every few seconds elsewhere.
class Progress {
 public:
  Progress(bool quiet, Clock::time_point start) : quiet_(quiet), start_(start), shown_(start), measured_(start) {}

  void show(const LiveTally& tally, Clock::time_point now) {
    if (quiet_ || now - shown_ < (terminal_ ? kTerminalEvery : kPlainEvery)) return;
    measure_rate(tally.sessions().received(), now);
    const std::string line = tally.progress_line(seconds(now - start_), ticks_per_s_);
    std::fprintf(stderr, terminal_ ? "\r%s\033[K" : "%s\n", line.c_str());
    shown_ = now;
    open_line_ = terminal_;
  }
  ~Progress() {
    if (open_line_) std::fputc('\n', stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  /// Over a second or more, because ticks come in batches.
  void measure_rate(std::int64_t received, Clock::time_point now) {
    if (now - measured_ < milliseconds(1000)) return;
    ticks_per_s_ = static_cast<double>(received - received_) / seconds(now - measured_);
    measured_ = now;
    received_ = received;
  }

  bool quiet_, terminal_ = isatty(STDERR_FILENO) == 1, open_line_ = false;
  Clock::time_point start_, shown_, measured_;
  std::int64_t received_ = 0;
  double ticks_per_s_ = 0.0;
};

/// Receives until the end of the run; the link's handler writes and counts, `fill` closes gaps.
void record_until_stopped(LcmLink& link, const LiveTally& tally, const RecordOptions& options,
                          const std::function<void()>& fill) {
  const auto start = Clock::now();
  auto filled = start;
  Progress progress(options.quiet, start);
  for (auto now = start; !console::stop_requested(); now = Clock::now()) {
    if (options.duration_s > 0.0 && seconds(now - start) >= options.duration_s) break;
    link.receive(50);
    if (now - filled >= kFillEvery) {
      fill();
      filled = now;
    }
    progress.show(tally, now);
  }
  const auto stopped = Clock::now();
  while (Clock::now() - stopped < kLongestDrain && link.receive(kQuiet_ms) > 0) {
  }
  fill();
}

/// What goes into the log: everything heard, and what the flight recorder has of what was not.
class Recording {
 public:
  Recording(LogWriter& log, LiveTally& tally) : log_(log), tally_(tally) {}

  void take(const Message& message) {
    log_.write(message.received_us, message.channel, message.data);
    tally_.add(message.channel, message.data);
    if (message.channel != kStatusChannel) return;
    if (const auto status = decode<ligature_msg::status_t>(message.data)) filler_.note(*status);
  }
  void fill() {
    filled_ += filler_.fill(tally_.sessions(), [this](const ligature_msg::tick_batch_t& batch) {
      bytes_.resize(static_cast<std::size_t>(batch.getEncodedSize()));
      batch.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
      log_.write(now_us(), kTicksChannel, bytes_);
      waiting_.push_back(bytes_);
    });
    for (const auto& bytes : waiting_) tally_.add(kTicksChannel, bytes);  // not while its gaps are being read
    waiting_.clear();
  }
  void say() const {
    if (filled_ > 0) std::printf("%lld of the ticks came from the flight recorder\n", static_cast<long long>(filled_));
  }

 private:
  LogWriter& log_;
  LiveTally& tally_;
  GapFiller filler_;
  std::vector<std::byte> bytes_;
  std::vector<std::vector<std::byte>> waiting_;
  std::int64_t filled_ = 0;
};

}  // namespace

void record(const RecordOptions& options) {
  LiveTally tally;
  std::optional<Recording> recording;  // the network comes first: without it no file is made
  LcmLink link(options.lcm_url, "LIGATURE_.*", [&](const Message& message) {
    if (recording) recording->take(message);
  });
  const std::string out = options.force ? file_to_write(options.out) : options.out;
  LogWriter log(out, options.force);
  recording.emplace(log, tally);
  try {
    record_until_stopped(link, tally, options, [&] { recording->fill(); });
    log.close();
  } catch (const RunFailed&) {
    std::fputs(tally.summary().c_str(), stdout);
    throw;
  }
  std::fputs(tally.summary().c_str(), stdout);
  recording->say();
  if (tally.messages() > 0) {
    std::printf("%s: %.1f MB\n", options.out.c_str(), static_cast<double>(log.bytes()) * 1e-6);
    return;
  }
  if (std::filesystem::is_regular_file(out)) std::filesystem::remove(out);  // an empty log helps nobody
  throw RunFailed("no message came on " + options.lcm_url +
                  "; is ligature-firmware running with the same --lcm-url "
                  "in the same network namespace?");
}

}  // namespace ligature::host
