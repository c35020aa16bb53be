#pragma once
// Output files of a rerun.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/lab/rerun/rerun.hpp"
#include "host/lab/rerun/rerun_log.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {

/// The rerun's log and two tables; each table gets its final name when it is complete.
class RerunFiles final : public RerunOutput {
 public:
  /// Creates the folder and removes the files of an earlier rerun. @throws Refusal, host::BadInput.
  RerunFiles(const std::filesystem::path& folder, const std::vector<std::string>& overrides, double period_s);

  void begin(const host::LogEvent& event) override { log_.begin(event); }
  void add(const ligature_msg::tick_t& recorded, const ligature_msg::tick_t& again,
           std::optional<double> cost_us) override;
  void add_unknown(const ligature_msg::tick_t& recorded) override { log_.add(recorded); }
  void add(const ligature_msg::thread_t& recorded, const ligature_msg::thread_t& again) override;
  void add(const ligature_msg::status_t& status) override { log_.add(status); }
  void copy(const host::LogEvent& event) override { log_.copy(event); }
  void end_batch(const ligature_msg::tick_batch_t& like) override { log_.end_batch(like); }
  void close() override;

 private:
  RerunLog log_;
  CsvFile forces_, shapes_;
  double period_s_;
};

/// These files as the output of a rerun. @see RerunOptions
[[nodiscard]] std::function<std::unique_ptr<RerunOutput>(const RecordedRun&)> files_in(
    const std::filesystem::path& folder, const std::vector<std::string>& overrides);

/// Refuses a folder whose rerun.lcmlog is the recording to be read. @throws Refusal.
void refuse_own_output(const std::string& log, const std::filesystem::path& folder);

/// Text of summary.json.
[[nodiscard]] std::string to_json(const RerunOutcome& outcome);

}  // namespace ligature::lab
