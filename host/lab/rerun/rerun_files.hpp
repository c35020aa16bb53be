#pragma once
// Output files of a rerun.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/lab/rerun/differences.hpp"
#include "host/lab/rerun/rerun_log.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {

struct RerunOutcome;

/// The rerun's log and two tables; each table gets its final name when it is complete.
class RerunFiles {
 public:
  /// Creates the folder and removes the files of an earlier rerun. @throws Refusal, host::BadInput.
  RerunFiles(const std::filesystem::path& folder, const std::vector<std::string>& overrides, double period_s);

  void add(const ligature_msg::tick_t& recorded, const ligature_msg::tick_t& again, std::optional<double> cost_us);
  void add(const ligature_msg::thread_t& recorded, const ligature_msg::thread_t& again);
  void close();

  RerunLog log;

 private:
  CsvFile forces_, shapes_;
  double period_s_;
};

/// Refuses a folder whose rerun.lcmlog is the recording to be read. @throws Refusal.
void refuse_own_output(const std::string& log, const std::filesystem::path& folder);

/// Text of summary.json.
[[nodiscard]] std::string to_json(const RerunOutcome& outcome);

}  // namespace ligature::lab
