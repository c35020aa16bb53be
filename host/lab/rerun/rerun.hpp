#pragma once
// Plays the recorded hand motion of a session through the physics again and compares the result.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/lab/rerun/differences.hpp"
#include "host/lab/rerun/recorded_run.hpp"
#include "host/log_reader.hpp"
#include "ligature_msg/status_t.hpp"
#include "ligature_msg/tick_batch_t.hpp"

namespace ligature::lab {

/// Receives the results of a rerun while it runs, in the order of the recorded log. Implementations write files, or
/// arrays in memory.
class RerunOutput {
 public:
  virtual ~RerunOutput() = default;
  virtual void begin(const host::LogEvent& event) = 0;  ///< what follows comes from this recorded event
  /// A recomputed tick with its device forces, and the recorded one. cost_us: CPU time of the thread's ticks.
  virtual void add(const ligature_msg::tick_t& recorded, const ligature_msg::tick_t& again,
                   std::optional<double> cost_us) = 0;
  virtual void add_unknown(const ligature_msg::tick_t& recorded) = 0;  ///< a tick that could not be recomputed
  virtual void add(const ligature_msg::thread_t& recorded, const ligature_msg::thread_t& again) = 0;
  virtual void add(const ligature_msg::status_t& status) = 0;
  virtual void copy(const host::LogEvent& event) = 0;                             ///< an event that is not the thread's
  virtual void end_batch(const ligature_msg::tick_batch_t& like) { (void)like; }  ///< the ticks of a message are over
  virtual void close() = 0;
};

struct RerunOptions {
  std::string log{};
  std::vector<std::string> overrides{};
  bool cuts = true;  ///< end ticks early where the recorded ones ran out of time
  int session = 0;   ///< number from 1; 0: the only one
  /// Makes the output after recording and settings were accepted. Absent: nothing is written, only the differences are
  /// computed.
  std::function<std::unique_ptr<RerunOutput>(const RecordedRun& run)> output{};
  std::function<bool()> go_on = [] { return true; };  ///< asked at each event of the log; false stops the rerun
};

struct RerunOutcome {
  Differences differences;
  std::int64_t ticks = 0;  ///< ticks of the session in the log
  double period_s = 0.001;
  std::int64_t unknown_ticks = 0;  ///< ticks for which the thread's state is unknown, because records are missing
  std::string why_unknown;         ///< why the state became unknown the last time
  std::int64_t shapes_alone = 0;   ///< recorded shapes of such ticks, which have nothing to compare with
  bool interrupted = false;        ///< stopped by SIGINT or SIGTERM before the end
};

/// Runs to the end or to a stop signal. Changes the floating-point mode of the calling thread, as the firmware does.
/// @throws Refusal when the recording or the settings are refused; nothing has been written then.
[[nodiscard]] RerunOutcome rerun(const RerunOptions& options);

}  // namespace ligature::lab
