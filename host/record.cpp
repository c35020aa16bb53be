#include "host/record.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "host/atomic_file.hpp"
#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"
#include "host/live_tally.hpp"
#include "host/log_writer.hpp"
#include "host/recording.hpp"

namespace ligature::host {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr auto kTerminalEvery = milliseconds(250);  // interval of progress reports on a terminal
constexpr auto kPlainEvery = milliseconds(5000);    // interval of progress reports when stderr is no terminal
constexpr auto kFillEvery = milliseconds(1000);     // interval of filling gaps from the flight recorder
constexpr auto kLongestDrain = milliseconds(300);   // after the stop: longest wait for messages still in transit
constexpr int kQuiet_ms = 100;                      // when no message came for so long, none is in transit

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Progress display: one line rewritten in place on a terminal, otherwise a new line every few seconds.
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
  /// Averages over 1 s or more, because ticks arrive in batches.
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

/// Receives until the stop. The link's handler records and counts the messages. This loop calls recording.fill() once a
/// second: ticks that the network lost are copied from the firmware's flight recorder file.
void record_until_stopped(LcmLink& link, const LiveTally& tally, const RecordOptions& options, Recording& recording) {
  const auto start = Clock::now();
  auto filled = start;
  Progress progress(options.quiet, start);
  for (auto now = start; !console::stop_requested(); now = Clock::now()) {
    if (options.duration_s > 0.0 && seconds(now - start) >= options.duration_s) break;
    link.receive(50);
    if (now - filled >= kFillEvery) {
      recording.fill();
      filled = now;
    }
    progress.show(tally, now);
  }
  const auto stopped = Clock::now();
  bool is_quiet = false;
  while (!is_quiet && Clock::now() - stopped < kLongestDrain) is_quiet = link.receive(kQuiet_ms) == 0;
  recording.finish(is_quiet);
}

}  // namespace

void record(const RecordOptions& options) {
  LiveTally tally;
  std::optional<Recording> recording;  // created after the link: without a network no file is made
  LcmLink link(options.lcm_url, "LIGATURE_.*", [&](const Message& message) {
    if (recording) recording->take(message);
  });
  const std::string out = options.force ? file_to_write(options.out) : options.out;
  LogWriter log(out, options.force);
  recording.emplace(log, tally, options.flight_folders.empty() ? default_flight_folders() : options.flight_folders);
  try {
    record_until_stopped(link, tally, options, *recording);
    log.close();
  } catch (const RunFailed&) {
    std::fputs(recording->summary().c_str(), stdout);
    throw;
  }
  std::fputs(recording->summary().c_str(), stdout);
  if (log.bytes() > 0) {
    std::printf("%s: %.1f MB\n", options.out.c_str(), static_cast<double>(log.bytes()) * 1e-6);
    return;
  }
  // Removes the empty log. An old file that --force would have replaced stays.
  if (std::filesystem::is_regular_file(out) && std::filesystem::file_size(out) == 0) std::filesystem::remove(out);
  throw RunFailed((tally.messages() > 0 ? "no message that can be recorded came on " : "no message came on ") +
                  options.lcm_url +
                  "; is ligature-firmware running with the same --lcm-url "
                  "in the same network namespace?");
}

}  // namespace ligature::host
