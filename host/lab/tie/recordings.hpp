#pragma once
// The recordings of several runs: DIR/KNOT-SEED.lcmlog.

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "host/lab/outcome.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/tie/seeds.hpp"

namespace ligature::lab {

[[nodiscard]] inline std::filesystem::path recording_of(const std::filesystem::path& folder, const std::string& knot,
                                                        std::uint32_t seed) {
  return folder / (knot + "-" + std::to_string(seed) + ".lcmlog");
}

/// Checks that a file does not exist yet or, if `replace` is true, that it can be replaced. Called before the first
/// run, so that no finished run is lost by a refusal. @throws Refusal
inline void check_free(const std::filesystem::path& path, bool replace) {
  std::error_code none;
  if (!replace && std::filesystem::exists(std::filesystem::symlink_status(path, none)))
    throw Refusal(path.string() + ": exists; allowed: another --out, or --force to replace it");
  check_outputs(path.parent_path(), {path.filename().c_str()});
}

/// The same for the recordings of all seeds. @throws Refusal with the name of the first that exists.
inline void check_free(const std::filesystem::path& folder, const std::string& knot, const Seeds& seeds, bool replace) {
  for (std::uint32_t seed = seeds.first; seed <= seeds.last; ++seed)
    check_free(recording_of(folder, knot, seed), replace);
}

/// A recording that gets its name only when its run is finished: written as NAME.part, removed otherwise. So an older
/// recording is replaced only by a whole one.
class UnfinishedRecording {
 public:
  explicit UnfinishedRecording(std::filesystem::path path) : path_(std::move(path)), part_(path_.string() + ".part") {
    std::filesystem::remove(part_);  // of a run that was killed
  }
  ~UnfinishedRecording() {
    std::error_code ignored;
    if (!part_.empty()) std::filesystem::remove(part_, ignored);
  }
  UnfinishedRecording(const UnfinishedRecording&) = delete;
  UnfinishedRecording& operator=(const UnfinishedRecording&) = delete;

  /// Path to write to.
  [[nodiscard]] std::string part() const { return part_.string(); }
  void finish() {
    std::filesystem::rename(part_, path_);
    part_.clear();
  }

 private:
  std::filesystem::path path_, part_;
};

}  // namespace ligature::lab
